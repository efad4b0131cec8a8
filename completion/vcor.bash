# Made by scripts/manual.py from vcor help --json
declare -A _vcor_options=()

_vcor() {
   local commands='run check material verify help'
   local line=${COMP_LINE:0:COMP_POINT} command=${COMP_WORDS[1]} word option options= kept= words=
   # the whole word before the cursor, which readline takes apart at = and :
   word=${line##*[[:space:]]}
   line=${line%"$word"}
   read -ra line <<<"$line"
   option=${line[-1]}
   if [ "${#line[@]}" -eq 1 ]; then
      words="$commands $(compgen -c vcor- | sed 's/^vcor-//')"
      mapfile -t COMPREPLY < <(compgen -W "$words" -- "$word")
      return
   fi
   if [[ $word == --*=* ]]; then
      option=${word%%=*}
      word=${word#*=}
   fi
   case $command in
      run) options='--set --output --print --threads --resume --quiet --help' ;;
      check) options='--set --help' ;;
      material) options='--set --output --from --to --points --quiet --help' ;;
      verify) options='--set --quiet --help' ;;
      help) options='--json --help' ;;
      *)
         [ -n "${_vcor_options[$command]}" ] || _vcor_options[$command]="$(
            "vcor-$command" --help 2>/dev/null </dev/null | grep -oE -e '--[a-z][a-z-]*' | sort -u)"
         options=${_vcor_options[$command]} ;;
   esac
   case $option in
      --set) words='case.title= impact.velocity= impact.drop_height= impact.temperature= impact.gravity= impact.bounces= sphere.shape=sphere sphere.shape=true_sphere sphere.shape=cone sphere.shape=punch sphere.shape=power sphere.radius= sphere.diameter= sphere.material= sphere.mass= sphere.mass= sphere.half_angle= sphere.punch_radius= sphere.profile_coefficient= sphere.profile_power= plate.half_thickness= plate.thickness= plate.material= plate.base=free plate.base=bonded plate.base=sliding plate.waves=none plate.waves=constant plate.waves=relaxing plate.waves=frozen plate.waves=hereditary plate.waves=body plate.surface_radius= plate.extent= target.body=plate target.body=beam target.body=rod target.body=block target.body=modes target.support=supported target.support=clamped target.support=cantilever target.support=free target.length= target.width= target.diameter= target.thickness= target.material= target.position= target.damping_ratio= target.mass= target.stiffness= target.damping= target.file= target.residual_compliance= contact.mechanics=paper contact.mechanics=exact contact.law=boltzmann contact.law=receding contact.pair=eq1 contact.pair=series solver.method=auto solver.method=ive solver.method=direct solver.method=coupled solver.scheme=product solver.scheme=adams_bashforth solver.time_step= solver.end_time= solver.accuracy= solver.form=a solver.form=b solver.quadrature=rectangle solver.quadrature=trapezoid solver.volterra_order= solver.volterra_coefficient= solver.continue_after_separation= output.csv= output.hdf5= output.history= output.directory= output.stem=' ;;
      --print | --quantity)
         words='cor cor_sphere contact_time max_indentation max_force residual_indentation residual_ratio hysteresis_energy wave_energy energy_loss initial_energy energy_imbalance contacts last_separation structure_energy bounces bouncing_time bouncing_time_error bounces_end min_frequency inelasticity loss_tangent cor_error cor_sphere_error contact_time_error max_force_error resilience rebound_height contact_radius contact_ratio thickness_ratio layer_ratio layer_stiffening layer_strain plate_wave_number needed_extent deflection_ratio highest_mode block_reach weight_ratio mass_ratio mean_pressure axis_tension cor_deviation wave_loss peak_loss_tangent peak_storage_modulus validity validity_cause steps status'
         kept=${word%"${word##*,}"} ;;
      help) words='accuracy activation_energy alpha axis_tension base beta block_reach body bounces bounces_end bouncing_time bouncing_time_error case check coefficient contact contact_radius contact_ratio contact_time contact_time_error contacts continue_after_separation cor cor_deviation cor_error cor_sphere cor_sphere_error count csv damping damping_ratio deflection_ratio density diameter directory drop_height end_time energy_imbalance energy_loss equilibrium_modulus exponent extent file form glassy_modulus gravity half_angle half_thickness hdf5 help highest_mode history hysteresis_energy impact inelasticity initial_energy input last_separation law layer_ratio layer_stiffening layer_strain length loss_tangent mass mass_ratio material max_force max_force_error max_indentation mean_pressure mechanics method min_frequency model moduli modulus modulus_kind modulus_unit name needed_extent output pair parameter peak_loss_tangent peak_storage_modulus plate plate_wave_number poisson_ratio position profile_coefficient profile_power punch_radius quadrature radius rates rebound_height reference_temperature relaxing_modulus residual_compliance residual_indentation residual_ratio resilience run scheme shape shift shift_file solver spacing sphere start status stem steps stiffness stop structure_energy support surface_radius sweep target temperature thickness thickness_ratio time time_step time_unit times title valid_from valid_temperature_from valid_temperature_to valid_to validity validity_cause values velocity verify vertical_shift viscosity volterra_coefficient volterra_order wave_energy wave_loss waves weight_ratio width wlf_c1 wlf_c2 yield_strength' ;;
      *) [[ $word != -* ]] || words=$options ;;
   esac
   # no word is left: names of files
   mapfile -t COMPREPLY < <(compgen -P "$kept" -W "$words" -- "${word#"$kept"}")
   if [[ ${COMPREPLY[0]} == *= ]]; then compopt -o nospace 2>/dev/null; fi
   COMPREPLY=("${COMPREPLY[@]#"${word%"${word##*[=:]}"}"}")
}
complete -o default -F _vcor vcor
