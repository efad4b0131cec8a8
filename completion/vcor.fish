# Made by scripts/manual.py from vcor help --json
function __vcor_programs
   set -l found $PATH/vcor-*
   path filter -fx -- $found | string replace -r '.*/vcor-' ''
end
function __vcor_described_programs
   for name in (__vcor_programs)
      switch $name
         case plot
            echo 'plot	draw figures of results'
         case page
            echo 'page	open a page of an impact in the browser, or write one as a file'
         case fit
            echo 'fit	identify a material from measured moduli'
         case identify
            echo 'identify	find materials from measured impacts, and what the data leave open'
         case uncertainty
            echo 'uncertainty	find how uncertain results are, and which values cause it'
         case export
            echo 'export	write the law of impact for DEM and multibody programs'
         case card
            echo 'card	write and read materials of finite element programs'
         case master
            echo 'master	make master curves of moduli at several temperatures'
         case table
            echo 'table	print measured data as the table that model = '\''table'\'' reads'
         case '*'
            echo $name
      end
   end
end
function __vcor_quantities
   printf '%s\n' cor cor_sphere contact_time max_indentation max_force residual_indentation residual_ratio hysteresis_energy wave_energy energy_loss initial_energy energy_imbalance contacts last_separation structure_energy bounces bouncing_time bouncing_time_error bounces_end min_frequency inelasticity loss_tangent cor_error cor_sphere_error contact_time_error max_force_error resilience rebound_height contact_radius contact_ratio thickness_ratio layer_ratio layer_stiffening layer_strain plate_wave_number needed_extent deflection_ratio highest_mode block_reach weight_ratio mass_ratio mean_pressure axis_tension cor_deviation wave_loss peak_loss_tangent peak_storage_modulus validity validity_cause steps status
end
function __vcor_options
   set -l name (commandline -opc)[2]
   command vcor-$name --help 2>/dev/null </dev/null | string match -ar -- '--[a-z][a-z-]*'
end
complete -c vcor -n 'not __fish_seen_subcommand_from run check material verify help (__vcor_programs)' -f -a '(__vcor_described_programs)'
complete -c vcor -n 'not __fish_seen_subcommand_from run check material verify help (__vcor_programs)' -f -a run -d 'solve impacts and write the results'
complete -c vcor -n '__fish_seen_subcommand_from run' -l set -x -a 'case.title= impact.velocity= impact.drop_height= impact.temperature= impact.gravity= impact.bounces= sphere.shape=sphere sphere.shape=true_sphere sphere.shape=cone sphere.shape=punch sphere.shape=power sphere.radius= sphere.diameter= sphere.material= sphere.mass= sphere.mass= sphere.half_angle= sphere.punch_radius= sphere.profile_coefficient= sphere.profile_power= plate.half_thickness= plate.thickness= plate.material= plate.base=free plate.base=bonded plate.base=sliding plate.waves=none plate.waves=constant plate.waves=relaxing plate.waves=frozen plate.waves=hereditary plate.waves=body plate.surface_radius= plate.extent= target.body=plate target.body=beam target.body=rod target.body=block target.body=modes target.support=supported target.support=clamped target.support=cantilever target.support=free target.length= target.width= target.diameter= target.thickness= target.material= target.position= target.damping_ratio= target.mass= target.stiffness= target.damping= target.file= target.residual_compliance= contact.mechanics=paper contact.mechanics=exact contact.law=boltzmann contact.law=receding contact.pair=eq1 contact.pair=series solver.method=auto solver.method=ive solver.method=direct solver.method=coupled solver.scheme=product solver.scheme=adams_bashforth solver.time_step= solver.end_time= solver.accuracy= solver.form=a solver.form=b solver.quadrature=rectangle solver.quadrature=trapezoid solver.volterra_order= solver.volterra_coefficient= solver.continue_after_separation= output.csv= output.hdf5= output.history= output.directory= output.stem=' -d 'replace a value of the case'
complete -c vcor -n '__fish_seen_subcommand_from run' -l output -r -d 'folder of the files, created if it does not exist'
complete -c vcor -n '__fish_seen_subcommand_from run' -l print -x -a '(__fish_complete_list , __vcor_quantities)' -d 'print these numbers only, one line per impact, in place of the table'
complete -c vcor -n '__fish_seen_subcommand_from run' -l threads -r -d 'threads of a sweep'
complete -c vcor -n '__fish_seen_subcommand_from run' -l resume -d 'continue an interrupted sweep'
complete -c vcor -n '__fish_seen_subcommand_from run' -l quiet -d 'print nothing but the numbers of --print'
complete -c vcor -n '__fish_seen_subcommand_from run' -l help -d 'explain the command'
complete -c vcor -n 'not __fish_seen_subcommand_from run check material verify help (__vcor_programs)' -f -a check -d 'validate a case and print it with all defaults'
complete -c vcor -n '__fish_seen_subcommand_from check' -l set -x -a 'case.title= impact.velocity= impact.drop_height= impact.temperature= impact.gravity= impact.bounces= sphere.shape=sphere sphere.shape=true_sphere sphere.shape=cone sphere.shape=punch sphere.shape=power sphere.radius= sphere.diameter= sphere.material= sphere.mass= sphere.mass= sphere.half_angle= sphere.punch_radius= sphere.profile_coefficient= sphere.profile_power= plate.half_thickness= plate.thickness= plate.material= plate.base=free plate.base=bonded plate.base=sliding plate.waves=none plate.waves=constant plate.waves=relaxing plate.waves=frozen plate.waves=hereditary plate.waves=body plate.surface_radius= plate.extent= target.body=plate target.body=beam target.body=rod target.body=block target.body=modes target.support=supported target.support=clamped target.support=cantilever target.support=free target.length= target.width= target.diameter= target.thickness= target.material= target.position= target.damping_ratio= target.mass= target.stiffness= target.damping= target.file= target.residual_compliance= contact.mechanics=paper contact.mechanics=exact contact.law=boltzmann contact.law=receding contact.pair=eq1 contact.pair=series solver.method=auto solver.method=ive solver.method=direct solver.method=coupled solver.scheme=product solver.scheme=adams_bashforth solver.time_step= solver.end_time= solver.accuracy= solver.form=a solver.form=b solver.quadrature=rectangle solver.quadrature=trapezoid solver.volterra_order= solver.volterra_coefficient= solver.continue_after_separation= output.csv= output.hdf5= output.history= output.directory= output.stem=' -d 'replace a value of the case, as for run'
complete -c vcor -n '__fish_seen_subcommand_from check' -l help -d 'explain the command'
complete -c vcor -n 'not __fish_seen_subcommand_from run check material verify help (__vcor_programs)' -f -a material -d 'compute moduli against time and frequency'
complete -c vcor -n '__fish_seen_subcommand_from material' -l set -x -a 'case.title= impact.velocity= impact.drop_height= impact.temperature= impact.gravity= impact.bounces= sphere.shape=sphere sphere.shape=true_sphere sphere.shape=cone sphere.shape=punch sphere.shape=power sphere.radius= sphere.diameter= sphere.material= sphere.mass= sphere.mass= sphere.half_angle= sphere.punch_radius= sphere.profile_coefficient= sphere.profile_power= plate.half_thickness= plate.thickness= plate.material= plate.base=free plate.base=bonded plate.base=sliding plate.waves=none plate.waves=constant plate.waves=relaxing plate.waves=frozen plate.waves=hereditary plate.waves=body plate.surface_radius= plate.extent= target.body=plate target.body=beam target.body=rod target.body=block target.body=modes target.support=supported target.support=clamped target.support=cantilever target.support=free target.length= target.width= target.diameter= target.thickness= target.material= target.position= target.damping_ratio= target.mass= target.stiffness= target.damping= target.file= target.residual_compliance= contact.mechanics=paper contact.mechanics=exact contact.law=boltzmann contact.law=receding contact.pair=eq1 contact.pair=series solver.method=auto solver.method=ive solver.method=direct solver.method=coupled solver.scheme=product solver.scheme=adams_bashforth solver.time_step= solver.end_time= solver.accuracy= solver.form=a solver.form=b solver.quadrature=rectangle solver.quadrature=trapezoid solver.volterra_order= solver.volterra_coefficient= solver.continue_after_separation= output.csv= output.hdf5= output.history= output.directory= output.stem=' -d 'replace a value of the case, as for run'
complete -c vcor -n '__fish_seen_subcommand_from material' -l output -r -d 'folder of the files, or the one file, as for run'
complete -c vcor -n '__fish_seen_subcommand_from material' -l from -r -d 'first time [s]'
complete -c vcor -n '__fish_seen_subcommand_from material' -l to -r -d 'last time [s]'
complete -c vcor -n '__fish_seen_subcommand_from material' -l points -r -d 'number of times'
complete -c vcor -n '__fish_seen_subcommand_from material' -l quiet -d 'print nothing'
complete -c vcor -n '__fish_seen_subcommand_from material' -l help -d 'explain the command'
complete -c vcor -n 'not __fish_seen_subcommand_from run check material verify help (__vcor_programs)' -f -a verify -d 'verify the program, or cases'
complete -c vcor -n '__fish_seen_subcommand_from verify' -l set -x -a 'case.title= impact.velocity= impact.drop_height= impact.temperature= impact.gravity= impact.bounces= sphere.shape=sphere sphere.shape=true_sphere sphere.shape=cone sphere.shape=punch sphere.shape=power sphere.radius= sphere.diameter= sphere.material= sphere.mass= sphere.mass= sphere.half_angle= sphere.punch_radius= sphere.profile_coefficient= sphere.profile_power= plate.half_thickness= plate.thickness= plate.material= plate.base=free plate.base=bonded plate.base=sliding plate.waves=none plate.waves=constant plate.waves=relaxing plate.waves=frozen plate.waves=hereditary plate.waves=body plate.surface_radius= plate.extent= target.body=plate target.body=beam target.body=rod target.body=block target.body=modes target.support=supported target.support=clamped target.support=cantilever target.support=free target.length= target.width= target.diameter= target.thickness= target.material= target.position= target.damping_ratio= target.mass= target.stiffness= target.damping= target.file= target.residual_compliance= contact.mechanics=paper contact.mechanics=exact contact.law=boltzmann contact.law=receding contact.pair=eq1 contact.pair=series solver.method=auto solver.method=ive solver.method=direct solver.method=coupled solver.scheme=product solver.scheme=adams_bashforth solver.time_step= solver.end_time= solver.accuracy= solver.form=a solver.form=b solver.quadrature=rectangle solver.quadrature=trapezoid solver.volterra_order= solver.volterra_coefficient= solver.continue_after_separation= output.csv= output.hdf5= output.history= output.directory= output.stem=' -d 'replace a value of the case, as for run'
complete -c vcor -n '__fish_seen_subcommand_from verify' -l quiet -d 'print nothing'
complete -c vcor -n '__fish_seen_subcommand_from verify' -l help -d 'explain the command'
complete -c vcor -n 'not __fish_seen_subcommand_from run check material verify help (__vcor_programs)' -f -a help -d 'explain a command or a word'
complete -c vcor -n '__fish_seen_subcommand_from help' -l json -d 'print everything about its commands'
complete -c vcor -n '__fish_seen_subcommand_from help' -l help -d 'explain the command'
complete -c vcor -n '__fish_seen_subcommand_from help' -f -a 'accuracy activation_energy alpha axis_tension base beta block_reach body bounces bounces_end bouncing_time bouncing_time_error case check coefficient contact contact_radius contact_ratio contact_time contact_time_error contacts continue_after_separation cor cor_deviation cor_error cor_sphere cor_sphere_error count csv damping damping_ratio deflection_ratio density diameter directory drop_height end_time energy_imbalance energy_loss equilibrium_modulus exponent extent file form glassy_modulus gravity half_angle half_thickness hdf5 help highest_mode history hysteresis_energy impact inelasticity initial_energy input last_separation law layer_ratio layer_stiffening layer_strain length loss_tangent mass mass_ratio material max_force max_force_error max_indentation mean_pressure mechanics method min_frequency model moduli modulus modulus_kind modulus_unit name needed_extent output pair parameter peak_loss_tangent peak_storage_modulus plate plate_wave_number poisson_ratio position profile_coefficient profile_power punch_radius quadrature radius rates rebound_height reference_temperature relaxing_modulus residual_compliance residual_indentation residual_ratio resilience run scheme shape shift shift_file solver spacing sphere start status stem steps stiffness stop structure_energy support surface_radius sweep target temperature thickness thickness_ratio time time_step time_unit times title valid_from valid_temperature_from valid_temperature_to valid_to validity validity_cause values velocity verify vertical_shift viscosity volterra_coefficient volterra_order wave_energy wave_loss waves weight_ratio width wlf_c1 wlf_c2 yield_strength'
complete -c vcor -n '__fish_seen_subcommand_from (__vcor_programs)' -a '(__vcor_options)'
