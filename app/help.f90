!> Help pages
module vcor_app_help
   use vcor_error, only : error_t, error_usage, raise
   use vcor_nearest, only : nearest_name, suggestion
   use vcor_text, only : printable
   use vcor_version, only : version
   use vcor_app_input_help, only : input_page, input_words
   use vcor_app_output_help, only : output_page, output_words
   implicit none
   private

   public :: help_text

   !> End of a line
   character(len=*), parameter :: nl = new_line('a')
   !> Known topics
   character(len=*), parameter :: topics = &
      'run merge check material fit plot verify input output help'

contains

   !> A help page
   subroutine help_text(topic, text, error)
      !> Topic, empty for the overview; also a group, a key or a choice of the input, a column or a
      !> status of the output
      character(len=*), intent(in) :: topic
      !> The page
      character(len=:), allocatable, intent(out) :: text
      !> Error of code `error_usage`, unallocated on success
      type(error_t), allocatable, intent(out) :: error

      character(len=:), allocatable :: words

      select case (topic)
      case ('', 'help')
         text = overview()
      case ('run')
         text = run_page()
      case ('merge')
         text = merge_page()
      case ('check')
         text = check_page()
      case ('material')
         text = material_page()
      case ('fit')
         text = fit_page()
      case ('plot')
         text = plot_page()
      case ('verify')
         text = verify_page()
      case ('input')
         text = 'A case file holds Fortran namelists, &GROUP KEY = VALUE, ... /, in SI units.' &
            //nl//nl//input_page()
      case ('output')
         text = output_page()
      case default
         text = input_page(topic)
         words = output_page(topic)
         if (text /= '' .and. words /= '') text = text//nl
         text = text//words
         if (text /= '') return
         ! too many words to be listed, not to look for one nearby
         words = topics//input_words()//output_words()
         if (nearest_name(topic, words) == '') then
            text = suggestion(topic, topics)//', or a word of the input or the output'
         else
            text = suggestion(topic, words)
         end if
         call raise(error, error_usage, "no help on '"//printable(topic)//"'; "//text)
      end select
   end subroutine help_text

   !> Overview
   function overview() result(text)
      !> The page
      character(len=:), allocatable :: text

      text = 'vcor '//version//': coefficient of restitution of viscoelastic impacts'//nl//nl &
         //'usage: vcor run CASE.nml ... [options]    solve impacts, write their results'//nl &
         //'       vcor merge SHARD.h5 ...            one sweep from its shards'//nl &
         //'       vcor check CASE.nml ...            validate, print with all defaults'//nl &
         //'       vcor material CASE.nml ...         moduli over time and frequency'//nl &
         //'       vcor fit DATA                      identify a material from data'//nl &
         //'       vcor plot RESULT.h5 ...            figures of results'//nl &
         //'       vcor verify [CASE.nml ...]         verify the program, or cases'//nl &
         //'       vcor help [TOPIC]                  topics: run, merge, check, material,'//nl &
         //'                                          fit, plot, verify, input, output,'//nl &
         //'                                          or a word of the input or the output'//nl &
         //'       vcor --version'//nl//nl &
         //'exit codes: 0 success, 1 internal error, 2 usage, 3 input, 4 file, ' &
         //'5 numerical failure'//nl
      text = text//nl//'pages of the manual: vcor help [input|output] --man, or --markdown'//nl
   end function overview

   !> Page of run
   function run_page() result(text)
      !> The page
      character(len=:), allocatable :: text

      text = 'usage: vcor run CASE.nml ... [options]'//nl//nl &
         //'Solves the impact of each case and writes STEM_summary.csv, STEM.csv (the time'//nl &
         //'history) and STEM.h5 (both), STEM being the name of the case file.'//nl//nl &
         //'Where a case has &sweep groups, the impacts of its grid: a row for each in the'//nl &
         //'summary, no history. A point that has no result (out of range, no separation,'//nl &
         //'numerical failure) has its status and nan in the row, the others go on, and the'//nl &
         //'exit code is 5.'//nl//nl &
         //'  --set GROUP.KEY=VALUE   replace a value of the case; a material is addressed'//nl &
         //"                          by its name: --set rubber.beta=600; may be repeated"//nl &
         //'  --output DIR            directory of the files, made if it is not there'//nl &
         //'  --print NAME,NAME       print bare numbers instead of the table, a line per'//nl &
         //'                          impact, and write files only if --output is given;'//nl &
         //'                          names: vcor help output, or a parameter that is swept'//nl &
         //'  --threads N             threads of a sweep; default: as many as there are cores'//nl &
         //'  --resume                go on with a sweep that was interrupted'//nl &
         //'  --shard I/N             solve part I of N of a sweep, to STEM_shard_I_of_N.h5;'//nl &
         //'                          vcor merge makes one of them'//nl &
         //'  --quiet                 print nothing'//nl//nl &
         //'A sweep that takes more than a moment keeps what is finished in STEM.part.h5, a'//nl &
         //'valid file at any time. SIGINT (Ctrl-C) and SIGTERM end it after the points at'//nl &
         //'work, with exit code 130 or 143. With --resume the same command goes on, after a'//nl &
         //'crash too, and gives the same files. A file of another case, or of another'//nl &
         //'version, is refused.'//nl &
         //'Results of another case are replaced, and that is said; unfinished ones are not.'//nl &
         //'Built for MPI (cmake --preset mpi), mpirun vcor run shares a sweep among ranks.'//nl
   end function run_page

   !> Page of merge
   function merge_page() result(text)
      !> The page
      character(len=:), allocatable :: text

      text = 'usage: vcor merge STEM_shard_*.h5 [options]'//nl//nl &
         //'Makes STEM_summary.csv and STEM.h5 of the files that vcor run --shard I/N has'//nl &
         //'written, the same as one run makes. All N shards are needed, each once, finished,'//nl &
         //'of the same case and version. Exit code 5: points without result, as for run.'//nl//nl &
         //'  --output DIR            directory of the files, made if it is not there;'//nl &
         //'                          default: that of the case'//nl &
         //'  --quiet                 print nothing'//nl
   end function merge_page

   !> Page of check
   function check_page() result(text)
      !> The page
      character(len=:), allocatable :: text

      text = 'usage: vcor check CASE.nml ... [--set GROUP.KEY=VALUE]'//nl//nl &
         //'Validates each case and prints it with every default filled in; what it prints is'//nl &
         //'a case file again.'//nl
   end function check_page

   !> Page of material
   function material_page() result(text)
      !> The page
      character(len=:), allocatable :: text

      text = 'usage: vcor material CASE.nml ... [options]'//nl//nl &
         //'Computes the moduli of each material of a case, relaxation over time, storage,'//nl &
         //'loss and loss tangent over angular frequency, and solves the impact for the'//nl &
         //'window that matters to it: t <= t0 and omega >= 2 pi/t0. Writes'//nl &
         //'  STEM_material.csv             a row per material: glassy and rubbery modulus,'//nl &
         //'                                values at t0 and 2 pi/t0'//nl &
         //'  STEM_material_relaxation.csv  material, time, relaxation_modulus, in_window'//nl &
         //'  STEM_material_dynamic.csv     material, frequency, storage_modulus,'//nl &
         //'                                loss_modulus, loss_tangent, in_window'//nl &
         //'  STEM_material.h5              all of them: /summary, /relaxation, /dynamic;'//nl &
         //'                                t0 and 2 pi/t0 are attributes, contact_time'//nl &
         //'                                and min_frequency'//nl//nl &
         //'Where a case has &sweep groups, its first point counts.'//nl//nl &
         //'  --from T --to T         first and last time [s]; default: from the glassy to'//nl &
         //'                          the rubbery plateau, the contact time included. The'//nl &
         //'                          frequencies are the reciprocals of the times'//nl &
         //'  --points N              number of times; default: 50 to the decade'//nl &
         //'  --set GROUP.KEY=VALUE   replace a value of the case, as for run; repeatable'//nl &
         //'  --output DIR            directory of the files, made if it is not there'//nl &
         //'  --quiet                 print nothing'//nl
   end function material_page

   !> Page of fit
   function fit_page() result(text)
      !> The page
      character(len=:), allocatable :: text

      text = 'usage: vcor fit DATA [options]'//nl &
         //'       vcor fit --from-model CASE.nml[:MATERIAL] [options]'//nl//nl &
         //'Fits a material to a file of columns, time and relaxation modulus or frequency,'//nl &
         //'storage and loss modulus (or loss tangent), and prints its parameters with'//nl &
         //'standard errors, the misfit, the band of the data and a &material group to be'//nl &
         //'pasted into a case. DATA may be - for the standard input. Columns are told by a'//nl &
         //'header (t,E or f,E_stor,E_loss ...), units by the header, by a second line of'//nl &
         //'units or by --units; other lines before the header are passed over. Without a'//nl &
         //'header, two columns are s and Pa, three are rad/s, Pa and Pa. Times in s and'//nl &
         //'moduli in Pa are what a header means that names no units.'//nl//nl &
         //'  --model NAME            prony (default), sls, power_law, cerf, mittag_leffler'//nl &
         //'  --terms N               terms of a Prony series; default: as many as the data'//nl &
         //'                          support, or until the largest misfit is below 0.05 %'//nl &
         //'  --fix KEY=VALUE         give a parameter, in SI units; may be repeated'//nl &
         //'  --units LIST            units of the columns: s,MPa or Hz,MPa or rad/s,Pa ...'//nl &
         //'  --shear                 the moduli are shear moduli G: E = 2 (1 + nu) G'//nl &
         //'  --poisson-ratio NU      of the material; default 0.5, of shear moduli required'//nl &
         //'  --density RHO           of the material [kg/m3]'//nl &
         //'  --name NAME             of the material; default: that of the file'//nl &
         //'  --output PATH           write the group to NAME.nml, or to DATA_fit.nml in a'//nl &
         //'                          folder of another name, made if it is not there'//nl &
         //'  --quiet                 print nothing'//nl//nl &
         //'With --from-model a material of a case is sampled in place of data, the one that'//nl &
         //'is named or that of the plate, and its impact is solved with it and with the fit.'//nl &
         //'  --from T --to T         first and last time [s]; default: from 1e-5 to 10 times'//nl &
         //'                          the contact time, in whole decades'//nl &
         //'  --points N              number of samples; default: 50 to the decade'//nl &
         //'  --dynamic               sample storage and loss modulus, over the reciprocals'//nl &
         //'  --set GROUP.KEY=VALUE   replace a value of the case'//nl//nl &
         //'The keys valid_from and valid_to of the group tell the band of the data. vcor run'//nl &
         //'warns where the cor of an impact changes by more than 1e-4 with the modulus held'//nl &
         //'constant outside of it.'//nl//nl &
         //'A standard error is a third of the way to the further end of the interval of three' &
         //nl &
         //'standard errors. A parameter at its bound has one too: 0 +- 1E+5 may be 1E+5, and'//nl &
         //'the errors of the others allow for it.'//nl//nl &
         //'A note says where the misfits are above 0.5 % and no noise: then the model does'//nl &
         //'not follow the data. Where the modulus still falls at the end of the data, an'//nl &
         //'error holds only if nothing relaxes later, and the equilibrium modulus of a'//nl &
         //'series is "not seen": what is fitted holds all that relaxes later.'//nl//nl &
         //'exit code 5: the fit does not converge, or the data do not determine the'//nl &
         //'parameters.'//nl
   end function fit_page

   !> Page of plot
   function plot_page() result(text)
      !> The page
      character(len=:), allocatable :: text

      text = 'usage: vcor plot RESULT.h5 ... [options]'//nl//nl &
         //'Draws the results of vcor run and vcor material through gnuplot, several of one'//nl &
         //'kind in one figure with a legend. Kinds:'//nl &
         //'  history  indentation, velocity and force over time, each over its largest'//nl &
         //'           value; dashed: ghost lines after contact; values at its end marked'//nl &
         //'  loop     contact force over indentation, the energy lost in the legend'//nl &
         //'  moduli   relaxation modulus over time, storage and loss modulus and loss'//nl &
         //'           tangent over frequency, for each material'//nl &
         //'  sweep    quantities of the summary over the parameter that is swept'//nl &
         //'  map      a quantity over two parameters, as contours'//nl//nl &
         //'  --kind KIND             default: what the file holds; of an impact history,'//nl &
         //'                          of a sweep of one parameter sweep, of two map'//nl &
         //'  --quantity NAME,NAME    what sweep and map show, sweep a panel for each;'//nl &
         //'                          default: cor; names: vcor help output'//nl &
         //'  --legend TEXT           text of the legend, once for each file, in order;'//nl &
         //'                          default: titles, or in what the cases differ'//nl &
         //'  --output PATH           NAME.svg, .pdf or .png: the figure; another name: the'//nl &
         //'                          folder of STEM_KIND.svg, made if it is not there;'//nl &
         //'                          default: STEM_KIND.svg in the current directory'//nl &
         //'  --format FORMAT         svg, pdf, png; default: what PATH ends with, else svg'//nl &
         //'  --script                leave the script of gnuplot and its data, FILE with'//nl &
         //'                          .gp and .dat, for work by hand'//nl &
         //'  --quiet                 print nothing'//nl//nl &
         //'Figures are 8.5 cm wide, a column, or 17 cm, a page. Where gnuplot is missing the'//nl &
         //'script is written and the exit code is 4.'//nl
   end function plot_page

   !> Page of verify
   function verify_page() result(text)
      !> The page
      character(len=:), allocatable :: text

      text = 'usage: vcor verify [CASE.nml ...] [options]'//nl//nl &
         //'Without a case: evaluates laws of impact and independent numbers. Each row'//nl &
         //'says what is expected, what is found and how far off it may be.'//nl//nl &
         //'With cases: solves each one by internal variables (ive) at its accuracy and'//nl &
         //'at a hundredth of it, and by product integration (direct) with 1000, 2000 and'//nl &
         //'4000 steps per contact, extrapolated. A scheme of its own that the case asks'//nl &
         //'for stands beside them. No files are written. The columns:'//nl &
         //'  states    error of cor that the solution states'//nl &
         //'  off by    distance from the best cor; honest if at most three times as much'//nl &
         //'  dW/KE_0   what the energies miss, over the energy before the impact'//nl &
         //'  order     order of convergence of direct'//nl &
         //'  digits    significant digits that can be trusted: those that the solution'//nl &
         //'            at the accuracy of the case shares with the best of both methods'//nl//nl &
         //'  --set GROUP.KEY=VALUE   replace a value of the case, as for run; repeatable'//nl &
         //'  --quiet                 print nothing'//nl//nl &
         //'exit code 5: a row fails; or the methods disagree by more than they state,'//nl &
         //'the energies do not close or a solution fails. A contact that does not end is'//nl &
         //'no failure where both methods say so.'//nl
   end function verify_page

end module vcor_app_help
