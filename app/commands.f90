!> The commands and their options in one table, from which the parser takes its options, and the
!> screens of help, `vcor help --json` and through it the manual their text.
module vcor_app_commands
   implicit none
   private

   public :: part_t, command_names, package_commands, page_of, options_of, texts_of
   public :: missing_package, commands, package_names

   !> One entry on the page of a command. Backquotes enclose literal input
   type :: part_t
      !> `command`, which begins a page; `usage`, `summary` or `example`; an option with the name of
      !> its value; another explained word; blank: a paragraph
      character(len=32) :: term
      !> Its text
      character(len=560) :: text
   end type part_t

   !> The pages, in order
   type(part_t), parameter :: pages(*) = [ &
      part_t("command", "run"), &
      part_t("usage", "vcor run CASE.nml ... [options]"), &
      part_t("summary", "solve impacts and write the results"), &
      part_t("", "Solves the impact of each case and writes three files: STEM_summary.csv (one " &
      //"row per impact), STEM.csv (the time history) and STEM.h5 (both). STEM is the name of " &
      //"the case file without its ending. With impact.bounces a fourth one, STEM_bounces.csv, " &
      //"has a row per bounce."), &
      part_t("", "A file that has only &material groups is not a case: it completes the cases " &
      //"before it. `vcor check`, `vcor material` and `vcor verify` accept such files, too."), &
      part_t("", "A case with &sweep groups is solved at every point of its grid. The summary " &
      //"has one row per point, and there is no time history. A point without a result (values " &
      //"out of range, no separation, numerical failure) gets a status and `nan` in its row. The " &
      //"other points are solved all the same, and the exit code is 5."), &
      part_t("--set GROUP.KEY=VALUE", "replace a value of the case; may be repeated. A material " &
      //"is addressed by its name: `--set rubber.beta=600`"), &
      part_t("--output PATH", "folder of the files, created if it does not exist; the file " &
      //"itself if one file is written and PATH has its ending (.h5 or .csv)"), &
      part_t("--print NAME,NAME", "print these numbers only, one line per impact, in place of " &
      //"the table, and write files only if `--output` is given. A name is a column " &
      //"(`vcor help output`) or a swept parameter"), &
      part_t("--threads N", "threads of a sweep; default: one per core"), &
      part_t("--resume", "continue an interrupted sweep"), &
      part_t("--quiet", "print nothing but the numbers of `--print`; warnings go to stderr"), &
      part_t("", "A sweep that takes longer than a second keeps the finished points in " &
      //"STEM.part, a text file. When the sweep is killed (Ctrl-C, SIGTERM, SIGKILL) or " &
      //"the disk is full, the same command with `--resume` solves the points that " &
      //"remain, and writes the same files as an uninterrupted run. Without `--resume` a " &
      //"sweep that has a STEM.part does not start. A STEM.part of another case or " &
      //"version, with other columns or with a wrong bit is refused."), &
      part_t("", "The screen names the mechanics of an impact and, if they are not exact, shows " &
      //"the result of the exact ones (law 'receding', pair 'series', and waves 'body' where the " &
      //"case has waves, or a thickness and a free plate). It lists the measures of validity " &
      //"that are not good; " &
      //"for a sweep, how many points that concerns, by which measure, and where. With " &
      //"`--print`, one line on stderr lists them. Numbers that no material has (a density of " &
      //"7.8 kg/m3) cause a warning."), &
      part_t("", "Results of the same names are replaced. A file is written as NAME.vcor.tmp " &
      //"and then renamed, so there is always the old file or the new one. The next run replaces " &
      //"a NAME.vcor.tmp that a killed one has left."), &
      part_t("", "In a build for MPI (`cmake --preset mpi`), `mpirun vcor run` shares a sweep " &
      //"among ranks."), &
      part_t("example", "vcor run examples/paper/sls.nml"), &
      part_t("example", "vcor run examples/paper/sls.nml --set impact.velocity=2.5 --print cor"), &
      !
      part_t("command", "check"), &
      part_t("usage", "vcor check CASE.nml ... [options]"), &
      part_t("summary", "validate a case and print it with all defaults"), &
      part_t("", "Validates each case and prints it with every default filled in. The output is " &
      //"a case file again."), &
      part_t("--set GROUP.KEY=VALUE", "replace a value of the case, as for run; repeatable"), &
      part_t("example", "vcor check examples/paper/sls.nml"), &
      !
      part_t("command", "material"), &
      part_t("usage", "vcor material CASE.nml ... [options]"), &
      part_t("summary", "compute moduli against time and frequency"), &
      part_t("", "Computes the moduli of each material of a case: relaxation modulus against " &
      //"time; storage modulus, loss modulus and loss tangent against angular frequency. It " &
      //"solves the impact as well, to mark the window that matters to it: t <= t0 and " &
      //"omega >= 2 pi/t0, with t0 the contact time. For a case with &sweep groups, the " &
      //"first point is taken."), &
      part_t("STEM_material.csv", "one row per material: glassy and rubbery modulus, values at " &
      //"t0 and 2 pi/t0"), &
      part_t("STEM_material_relaxation.csv", "material, time, relaxation_modulus, in_window"), &
      part_t("STEM_material_dynamic.csv", "material, frequency, storage_modulus, loss_modulus, " &
      //"loss_tangent, in_window"), &
      part_t("STEM_material.h5", "all of them as /summary, /relaxation and /dynamic; t0 and " &
      //"2 pi/t0 are the attributes contact_time and min_frequency"), &
      part_t("--set GROUP.KEY=VALUE", "replace a value of the case, as for run; repeatable"), &
      part_t("--output PATH", "folder of the files, or the one file, as for run"), &
      part_t("--from T", "first time [s]; default: on the glassy plateau, before the contact " &
      //"time"), &
      part_t("--to T", "last time [s]; default: on the rubbery plateau, after the contact time. " &
      //"The frequencies are the reciprocals of the times"), &
      part_t("--points N", "number of times; default: 50 per decade"), &
      part_t("--quiet", "print nothing"), &
      part_t("example", "vcor material examples/paper/sls.nml --from 1e-6 --to 10"), &
      !
      part_t("command", "verify"), &
      part_t("usage", "vcor verify [CASE.nml ...] [options]"), &
      part_t("summary", "verify the program, or cases"), &
      part_t("", "Without a case: compares the program with a number of each law of impact, " &
      //"from closed forms and independent programs. Each row shows the expected value, the " &
      //"value found, the deviation and its tolerance."), &
      part_t("", "With cases: solves each case by internal variables (ive), at its accuracy and " &
      //"at one hundredth of it, and by product integration (direct) with 1000, 2000 and 4000 " &
      //"steps per contact, extrapolated; with waves 'body' by the coupled contact, at its " &
      //"accuracy and at a tenth of it, or at half of the error that the first states if that " &
      //"is less. If the case asks for another scheme, that solution is shown too. A second " &
      //"table has the numbers of every plate model, both contact laws and, " &
      //"if it matters, both pairs. No files are written. The columns are:"), &
      part_t("states", "error of cor that the solution itself estimates"), &
      part_t("off by", "distance from the best cor; honest if at most three times the estimate"), &
      part_t("dW/KE_0", "energy imbalance, divided by the energy before the impact"), &
      part_t("order", "order of convergence of direct"), &
      part_t("digits", "significant digits to trust: those that the solution at the accuracy of " &
      //"the case shares with the best of both methods"), &
      part_t("--set GROUP.KEY=VALUE", "replace a value of the case, as for run; repeatable"), &
      part_t("--quiet", "print nothing"), &
      part_t("", "Ends with exit code 5 if a row fails, the methods disagree by more than their " &
      //"estimates, the energies do not close, or a solution fails. A contact that does not end " &
      //"is not a failure if both methods agree on it."), &
      part_t("example", "vcor verify examples/paper/sls.nml"), &
      !
      part_t("command", "help"), &
      part_t("usage", "vcor help [TOPIC]"), &
      part_t("summary", "explain a command or a word"), &
      part_t("", "Prints a page of help. TOPIC is a command, `input` (all groups and keys of a " &
      //"case), `output` (all columns and statuses), or any word of the input or the output: " &
      //"`vcor help velocity`, `vcor help prony`, `vcor help sticks`."), &
      part_t("--json", "print everything about its commands, input and " &
      //"output as one JSON document"), &
      part_t("example", "vcor help velocity")]

   integer :: k
   !> Known commands
   character(len=8), parameter :: command_names(*) = &
      pack([(pages(k)%text(:8), k=1, size(pages))], pages%term == "command")

   !> Commands of the Python package, which are separate programs, and their summaries
   type(part_t), parameter :: package_commands(*) = [ &
      part_t("plot", "draw figures of results"), &
      part_t("page", "open a page of an impact in the browser, or write one as a file"), &
      part_t("fit", "identify a material from measured moduli"), &
      part_t("identify", "find materials from measured impacts, and what the data leave open"), &
      part_t("uncertainty", "find how uncertain results are, and which values cause it"), &
      part_t("export", "write the law of impact for DEM and multibody programs"), &
      part_t("card", "write and read materials of finite element programs"), &
      part_t("master", "make master curves of moduli at several temperatures"), &
      part_t("table", "print measured data as the table that model = 'table' reads")]

contains

   !> Names of the commands, separated by blanks
   pure function commands() result(names)
      character(len=:), allocatable :: names

      names = words_of(command_names)
   end function commands

   !> Names of the commands of the Python package, separated by blanks
   pure function package_names() result(names)
      character(len=:), allocatable :: names

      names = words_of(package_commands%term)
   end function package_names

   !> Words separated by blanks
   pure function words_of(list) result(words)
      character(len=*), intent(in) :: list(:)
      character(len=:), allocatable :: words

      integer :: i

      words = trim(list(1))
      do i = 2, size(list)
         words = words//" "//trim(list(i))
      end do
   end function words_of

   !> Advice if a command of the Python package is not installed
   pure function missing_package(word) result(text)
      character(len=*), intent(in) :: word
      !> One line; empty if the package has no such command
      character(len=:), allocatable :: text

      text = ""
      if (any(package_commands%term == word)) text = "there is no vcor-"//word//" in PATH; "//word &
         //" is a command of the Python package, expected pip install './python[all]' in the " &
         //"folder of the sources"
   end function missing_package

   !> Page of a command
   pure function page_of(command) result(page)
      !> One of `commands`
      character(len=*), intent(in) :: command
      !> Its page; shape (0) for any other word
      type(part_t), allocatable :: page(:)

      integer :: i, number

      number = findloc(command_names == command, .true., dim=1)
      page = pack(pages, [(count(pages(:i)%term == "command") == number .and. number > 0 &
         .and. pages(i)%term /= "command", i=1, size(pages))])
   end function page_of

   !> Options of a command, separated by blanks
   pure function options_of(command, flags_only) result(words)
      !> One of `commands`
      character(len=*), intent(in) :: command
      !> Whether to return only options without a value; absent: all
      logical, intent(in), optional :: flags_only
      !> Its options, including those of all commands
      character(len=:), allocatable :: words

      type(part_t), allocatable :: page(:)
      integer :: i, mark

      allocate (page, source=page_of(command))
      words = ""
      do i = 1, size(page)
         if (index(page(i)%term, "--") /= 1) cycle
         mark = index(page(i)%term//" ", " ")
         if (present(flags_only) .and. page(i)%term(mark:) /= "") cycle
         words = words//page(i)%term(:mark)
      end do
      words = words//"--help --version"
   end function options_of

   !> Texts of one kind on a page
   pure function texts_of(command, term) result(texts)
      !> One of `commands`
      character(len=*), intent(in) :: command
      !> `usage`, `summary` or `example`
      character(len=*), intent(in) :: term
      character(len=len(pages%text)), allocatable :: texts(:)

      type(part_t), allocatable :: page(:)

      allocate (page, source=page_of(command))
      allocate (texts, source=pack(page%text, page%term == term))
   end function texts_of

end module vcor_app_commands
