!> Tables, the files made of them, and how files are written
program test_output
   use, intrinsic :: ieee_arithmetic, only : ieee_negative_inf, ieee_positive_inf, ieee_quiet_nan, &
      & ieee_value
   use, intrinsic :: iso_c_binding, only : c_associated, c_loc, c_ptr
   use, intrinsic :: iso_fortran_env, only : int64
   use vcor_error, only : error_file, error_t
   use vcor_io_table, only : add_column, add_dimension, column_of, coordinate_row, &
      new_table, row_count, table_t, text_value
   use vcor_io_csv, only : write_csv
   use vcor_io_file, only : commit, create_file, discard, output_file_t, put, write_file, &
      write_stdout
   use vcor_io_hdf5, only : write_hdf5
   use vcor_text, only : integer_text
   use vcor_io_path, only : check_name, directory_exists, file_exists, join_path, &
      make_directory, quoted_path
   use vcor_io_posix, only : c_text
   use vcor_io_number, only : decimal_t, longest_real, new_decimal, put_real
   use vcor_kinds, only : wp
   use vcor_version, only : version
   use vcor_test, only : check, check_contains, check_text, finish, suite
   implicit none

   interface
      !> Make a folder with a new name; null on failure
      function c_mkdtemp(template) result(place) bind(c, name="mkdtemp")
         import :: c_ptr
         !> Address of a name that ends with XXXXXX and NUL; returns the name there
         type(c_ptr), intent(in), value :: template
         type(c_ptr) :: place
      end function c_mkdtemp
   end interface

   character(len=*), parameter :: lf = achar(10), cr = achar(13)
   !> Folder for the files of this test, removed at its end
   character(len=:), allocatable :: folder

   call suite("output")
   call make_folder()
   call test_numbers()
   call test_random_numbers()
   call test_paths()
   call test_make_directory()
   call test_write_file()
   call test_failed_write()
   call test_links()
   call test_long_paths()
   call test_stdout()
   call test_table()
   call test_csv()
   call test_csv_comments()
   call test_csv_grid()
   call test_hdf5()
   call execute_command_line("rm -rf "//quoted_path(folder))
   call finish()

contains

   !> A folder of our own, with a blank and a letter beyond ASCII in its name
   subroutine make_folder()
      character(len=1000) :: parent
      character(len=:), allocatable, target :: template
      integer :: status

      call get_environment_variable("TMPDIR", parent, status=status)
      if (status /= 0 .or. len_trim(parent) == 0) parent = "/tmp"
      template = c_text(join_path(parent, "vcor test é XXXXXX"))
      call check(c_associated(c_mkdtemp(c_loc(template))), "the folder of the test can be made")
      folder = template(:len(template)-1)
   end subroutine make_folder

   !> Numbers that are special in some way
   subroutine test_numbers()
      integer(int64) :: smallest
      integer :: lowest

      smallest = 1_int64
      lowest = -huge(1)
      lowest = lowest - 1
      call check_text(decimal_text(0.0_wp), "0.0000000000000000e+00", "zero")
      call check_text(decimal_text(-0.0_wp), "-0.0000000000000000e+00", "zero has a sign")
      call check_text(decimal_text(1.0_wp), "1.0000000000000000e+00", "one")
      call check_text(decimal_text(-0.1_wp), "-1.0000000000000001e-01", "a tenth is not exact")
      call check_text(decimal_text(1.0e23_wp), "9.9999999999999992e+22", "1e23 is not exact")
      call check_text(decimal_text(123456.0_wp), "1.2345600000000000e+05", "whole numbers")
      call check_text(decimal_text(1.0e-300_wp), "1.0000000000000000e-300", "exponent of 3 digits")
      call check_text(decimal_text(huge(1.0_wp)), "1.7976931348623157e+308", "largest number")
      call check_text(decimal_text(tiny(1.0_wp)), "2.2250738585072014e-308", "smallest normal")
      call check_text(decimal_text(transfer(smallest, 1.0_wp)), "4.9406564584124654e-324", &
         & "smallest number")
      ! 18 digits, the last one a five: a tie, which goes to the even digit
      call check_text(decimal_text(2.0_wp**(-25)*33554433.0_wp), "1.0000000298023224e+00", "no tie")
      call check_text(decimal_text(100000000000000005.0_wp*16), "1.6000000000000000e+18", "digits")
      call check_text(decimal_text(9007199254740993.0_wp*64), "5.7646075230342349e+17", "tie, even")
      call check_text(decimal_text(ieee_value(1.0_wp, ieee_quiet_nan)), "nan", "NaN")
      call check_text(decimal_text(ieee_value(1.0_wp, ieee_positive_inf)), "inf", "infinity")
      call check_text(decimal_text(ieee_value(1.0_wp, ieee_negative_inf)), "-inf", "minus infinity")
      call check_text(integer_text(0), "0", "integer zero")
      call check_text(integer_text(-120), "-120", "negative integer")
      call check_text(integer_text(huge(1)), "2147483647", "largest integer")
      call check_text(integer_text(lowest), "-2147483648", "smallest integer")
   end subroutine test_numbers

   !> Any number is written as the compiler rounds it, and read back bit for bit
   subroutine test_random_numbers()
      integer, parameter :: count = 20000
      character(len=:), allocatable :: text
      integer(int64) :: bits
      integer :: i, unlike, unread
      real(wp) :: back, u(2), x

      unlike = 0
      unread = 0
      do i = 1, count
         call random_number(u)
         select case (mod(i, 4))
         case (0)
            ! Any exponent, any fraction
            bits = ior(ishft(int(u(1)*2047, int64), 52), int(u(2)*2.0_wp**52, int64))
         case (1)
            ! Subnormal
            bits = int(u(1)*2.0_wp**(1 + int(51*u(2))), int64)
         case (2)
            ! Power of two
            bits = ishft(int(u(1)*2047, int64), 52)
         case default
            ! Few digits
            bits = transfer(int(1 + 1000*u(1))*10.0_wp**int(40*u(2) - 20), 1_int64)
         end select
         x = transfer(bits, 1.0_wp)
         text = decimal_text(x)
         if (text /= compiler_text(x)) unlike = unlike + 1
         read(text, *) back
         if (transfer(back, 1_int64) /= bits) unread = unread + 1
      end do
      call check(unlike == 0, "numbers are rounded correctly")
      call check(unread == 0, "numbers are read back bit for bit")
   end subroutine test_random_numbers

   !> A number as the compiler writes it, with the exponent as it is in C
   function compiler_text(x) result(text)
      !> Finite number
      real(wp), intent(in) :: x
      !> Its text
      character(len=:), allocatable :: text
      character(len=24) :: buffer
      integer :: e

      write(buffer, "(es24.16e3)") x
      text = trim(adjustl(buffer))
      e = index(text, "E")
      text(e:e) = "e"
      if (text(e+2:e+2) == "0") text = text(:e+1)//text(e+3:)
   end function compiler_text

   !> Joining and quoting
   subroutine test_paths()
      call check_text(join_path("out", "a.csv"), "out/a.csv", "a slash comes between")
      call check_text(join_path("out/", "a.csv"), "out/a.csv", "a slash that is there is enough")
      call check_text(join_path("/", "a.csv"), "/a.csv", "root")
      call check_text(join_path("", "a.csv"), "a.csv", "current directory")
      call check_text(join_path("out", "/a.csv"), "/a.csv", "absolute path")
      call check_text(join_path("out  ", "a.csv "), "out/a.csv", "padding does not count")
      call check_text(quoted_path("a"//lf//"b c"), "'a?b c'", "messages have one line")
      call refuses_name("a"//achar(9)//"b", "holds a tab")
      call refuses_name("a/b"//cr, "holds a line end")
      call refuses_name("a"//char(194)//char(133), "holds the control character 133")
      call refuses_name("|a", "begins with '|'")
      call refuses_name("/a/<b", "has a part that begins with '<'")
      call refuses_name("", "")
      call refuses_name("a|b/c<d é "//char(195)//char(133)//char(233), "")
   end subroutine test_paths

   !> A name that is refused with a reason, or taken where the reason is empty
   subroutine refuses_name(name, reason)
      !> The name
      character(len=*), intent(in) :: name
      !> The reason
      character(len=*), intent(in) :: reason
      type(error_t), allocatable :: error

      call check_name(name, error)
      if (reason == "") then
         call check(.not. allocated(error), "a good name: "//quoted_path(name))
      else
         call check_failed(error, reason, "a bad name: "//quoted_path(name))
      end if
   end subroutine refuses_name

   !> Directories
   subroutine test_make_directory()
      type(error_t), allocatable :: error
      character(len=:), allocatable :: deep, file

      deep = join_path(folder, "a//b c/ü/d")
      call make_directory(deep//"/", error)
      call check(.not. allocated(error), "parents are made too")
      call check(directory_exists(deep), "directory is there")
      call check(.not. file_exists(deep), "a directory is not a file")
      call make_directory(deep, error)
      call check(.not. allocated(error), "a directory that is there is fine")
      call make_directory("", error)
      call check(.not. allocated(error), "current directory")
      call make_directory("/", error)
      call check(.not. allocated(error), "root")
      call make_directory("/proc", error)
      call check(.not. allocated(error), "a directory that cannot be written is fine")

      file = join_path(deep, "file")
      call write_file(file, "text", error)
      call check(file_exists(file), "file is there")
      call check(.not. directory_exists(file), "a file is not a directory")
      call make_directory(file, error)
      call check_failed(error, "is a file, expected a directory", "file in the way")
      call make_directory(join_path(file, "below"), error)
      call check_failed(error, quoted_path(file)//" is a file", "file among the parents")
      call make_directory("/proc/vcor", error)
      call check_failed(error, "'/proc/vcor': No such file or directory", "nothing below /proc")
      call make_directory("a"//achar(0)//"b", error)
      call check_failed(error, "NUL", "NUL in the path of a directory")
   end subroutine test_make_directory

   !> Whole files
   subroutine test_write_file()
      type(error_t), allocatable :: error
      type(output_file_t) :: file
      character(len=:), allocatable :: path

      path = join_path(folder, "new.txt")
      call create_file(file, path, error)
      call check(.not. allocated(error), "file can be created")
      call put(file, "first"//lf, error)
      call put(file, "", error)
      call put(file, "second", error)
      call check(.not. file_exists(path), "nothing is there before the end")
      call check_temporaries(1, "while writing")
      call commit(file, error)
      call check(.not. allocated(error), "file can be ended")
      call check_text(content(path), "first"//lf//"second", "file holds what was written")
      call check_temporaries(0, "after success")

      call create_file(file, path, error)
      call put(file, "other", error)
      call discard(file)
      call check_text(content(path), "first"//lf//"second", "a file given up changes nothing")
      call check_temporaries(0, "after giving up")

      call execute_command_line("echo left > "//quoted_path(path//".vcor.tmp"))
      call write_file(path, "another", error)
      call check(.not. allocated(error), "what a killed process has left is replaced")
      call check_text(content(path), "another", "the file is new")
      call check_temporaries(0, "after what was left")

      call create_file(file, path, error)
      call put(file, "mine", error)
      call write_file(path, "theirs", error)
      call check(.not. allocated(error), "of two at once the later one succeeds")
      call put(file, " and more", error)
      call commit(file, error)
      call check_failed(error, "was deleted or replaced", "a file that another one has taken")
      call check_text(content(path), "theirs", "is not given the name")

      call write_file(path//"   ", "third", error)
      call check(.not. allocated(error), "padding of a path does not count")
      call check_text(content(path), "third", "old file is replaced")
   end subroutine test_write_file

   !> Files that cannot be written
   subroutine test_failed_write()
      type(error_t), allocatable :: error
      type(table_t) :: table
      character(len=:), allocatable :: path

      path = join_path(folder, "directory")
      call make_directory(path, error)
      call write_file(path, "text", error)
      call check_failed(error, quoted_path(path)//": it is a directory", "directory")
      call write_file(join_path(folder, "nothing/"), "text", error)
      call check_failed(error, "ends with a slash", "slash at the end")
      call write_file("", "text", error)
      call check_failed(error, "without a name", "no name")
      call write_file("a"//achar(0)//"b", "text", error)
      call check_failed(error, "NUL", "NUL in the name of a file")
      ! Not a device: if this failed, a run as root would replace it
      path = join_path(folder, "pipe")
      call execute_command_line("mkfifo "//quoted_path(path))
      call write_file(path, "text", error)
      call check_failed(error, quoted_path(path)//": it is a device or a pipe", "pipe")
      call write_file("/proc/vcor.csv", "text", error)
      call check_failed(error, "cannot write '/proc/vcor.csv': ", "directory without writing")
      path = join_path(folder, "none/file")
      call write_file(path, "text", error)
      call check_failed(error, quoted_path(path)//": No such file or directory", "no directory")
      path = join_path(folder, "file")
      call write_file(path, "text", error)
      path = join_path(path, "below")
      call write_file(path, "text", error)
      call check_failed(error, quoted_path(path)//": Not a directory", "file as directory")

      table = small_table()
      call write_csv(path, table, error)
      call check_failed(error, quoted_path(path)//": Not a directory", "csv below a file")
      call write_hdf5(path, [table], error)
      call check_failed(error, quoted_path(path)//": Not a directory", "hdf5 below a file")
      call check_temporaries(0, "after failures")
   end subroutine test_failed_write

   !> Symbolic links under the real name
   subroutine test_links()
      type(error_t), allocatable :: error
      character(len=:), allocatable :: link, target_path

      target_path = join_path(folder, "target")
      link = join_path(folder, "link")
      call write_file(target_path, "old", error)
      call execute_command_line("ln -s "//quoted_path(target_path)//" "//quoted_path(link))
      call write_file(link, "new", error)
      call check(.not. allocated(error), "a link can be replaced")
      call check_text(content(link), "new", "file stands in place of the link")
      call check_text(content(target_path), "old", "what the link points at is untouched")

      link = join_path(folder, "full.csv")
      call execute_command_line("ln -s /dev/full "//quoted_path(link))
      call write_file(link, "new", error)
      call check_failed(error, "it is a device or a pipe", "link to a device")
   end subroutine test_links

   !> Names as long as the system takes them, with the ending of a temporary name, and longer
   subroutine test_long_paths()
      type(error_t), allocatable :: error
      character(len=:), allocatable :: path
      integer :: i

      path = join_path(folder, repeat("n", 251))
      call write_file(path, "text", error)
      call check(.not. allocated(error), "longest name")
      call write_file(join_path(folder, repeat("n", 256)), "text", error)
      call check_failed(error, "File name too long", "name too long")

      path = folder
      do i = 1, 19
         path = join_path(path, repeat("d", 199))
      end do
      call make_directory(path, error)
      call check(.not. allocated(error), "long path of a directory")
      path = join_path(path, repeat("f", 4000 - len(path)))
      call write_file(path, "text", error)
      call check(.not. allocated(error), "long path of a file")
      call check(file_exists(path), "file with a long path is there")
      call write_file(join_path(repeat("d/", 3000), "file"), "text", error)
      call check_failed(error, "File name too long", "path too long")
   end subroutine test_long_paths

   !> Standard output; what happens if it is full is a test of the program
   subroutine test_stdout()
      type(error_t), allocatable :: error

      call write_stdout("", error)
      call check(.not. allocated(error), "nothing can be written to the standard output")
      call write_stdout("a line of the test"//lf, error)
      call check(.not. allocated(error), "a line can be written to the standard output")
   end subroutine test_stdout

   !> Building tables
   subroutine test_table()
      type(table_t) :: table
      integer :: i

      call new_table(table, "summary", "title  ", "case")
      call add_dimension(table, "row", 4)
      do i = 1, 100
         call add_column(table, column_of("column "//integer_text(i), real([i, i, i, i], wp), "m", &
            & "column"))
      end do
      call add_column(table, column_of("text", ["a   ", "    ", " bc ", "def "], "", "text"))
      call check_text(table%title, "title", "title is trimmed")
      call check(row_count(table) == 4, "number of rows")
      call check(size(table%columns) == 101, "number of columns")
      call check(all(nint(table%columns(1)%reals) == 1), "values stay when columns are added")
      call check(all(nint(table%columns(33)%reals) == 33), "values of a later column")
      call check_text(table%columns(100)%name, "column 100", "name of a column")
      call check(table%columns(101)%width == 3, "text is as wide as it has to be")
      call check_text(text_value(table%columns(101), 2), "", "empty text")
      call check_text(text_value(table%columns(101), 3), " bc", "text with a blank before it")

      call new_table(table, "summary", "grid", "case")
      call add_dimension(table, column_of("a", [1, 2], "1", "a"))
      call add_dimension(table, column_of("b", [1.0_wp, 2.0_wp, 3.0_wp], "1", "b"))
      call check(row_count(table) == 6, "rows of a grid")
      call check(all([(coordinate_row(table, 1, i), i = 1, 6)] == [1, 1, 1, 2, 2, 2]), "slow")
      call check(all([(coordinate_row(table, 2, i), i = 1, 6)] == [1, 2, 3, 1, 2, 3]), "fast")
   end subroutine test_table

   !> A plain table as CSV
   subroutine test_csv()
      type(error_t), allocatable :: error
      type(table_t) :: table
      character(len=:), allocatable :: path

      path = join_path(folder, "small.csv")
      call write_csv(path, small_table(), error)
      call check(.not. allocated(error), "table can be written as csv")
      call check_text(content(path), &
         & "# vcor "//version//lf// &
         & "# title: small"//lf// &
         & "# columns:"//lf// &
         & "#   cor [1] coefficient of restitution"//lf// &
         & "#   ""rubber, soft"".beta [s-1] rate"//lf// &
         & "#   status how it ended"//lf// &
         & "# case:"//lf// &
         & "# &case"//lf// &
         & "#   title = 'small'"//lf// &
         & "# /"//lf// &
         & "cor,""""""rubber, soft"""".beta"",status"//lf// &
         & "5.0000000000000000e-01,-3,""a, """"b"""""""//lf// &
         & "nan,0,"""""//lf, "csv of a small table")

      call new_table(table, "summary", "none", "")
      call add_dimension(table, "impact", 0)
      call add_column(table, column_of("cor", [real(wp) ::], "1", "cor"))
      call add_column(table, column_of("status", [character(len=3) ::], "", "status"))
      call write_csv(path, table, error)
      call check(.not. allocated(error), "table without rows can be written")
      call check_contains(content(path), lf//"cor,status"//lf, "table without rows has its names")

      ! Far more than the buffer holds
      call large_table(table)
      call write_csv(path, table, error)
      call check(.not. allocated(error), "large table can be written as csv")
      call check(len(content(path)) > 20000*len("1.0000000000000000e+00,word"//lf), &
         & "large table is complete")
      call check_contains(content(path), lf//decimal_text(1.0_wp/20000)//",word"//lf, "last row")
   end subroutine test_csv

   !> No line of the case may become a row
   subroutine test_csv_comments()
      type(error_t), allocatable :: error
      type(table_t) :: table
      character(len=:), allocatable :: path

      path = join_path(folder, "comments.csv")
      call new_table(table, "summary", "two"//lf//"lines", "a"//cr//lf//lf//"b"//cr//"c"//lf//lf)
      call add_dimension(table, column_of("time", [0.0_wp], "s", "time"))
      call write_csv(path, table, error)
      call check_contains(content(path), "# title: two"//lf//"# lines"//lf, "title of two lines")
      call check_contains(content(path), &
         & lf//"# case:"//lf//"# a"//lf//"# "//lf//"# b"//lf//"# c"//lf//"# "//lf//"time"//lf, &
         & "lines end with line feed, carriage return or both")
      call new_table(table, "summary", "long", repeat("x", 200000))
      call add_dimension(table, column_of("time", [0.0_wp], "s", "time"))
      call write_csv(path, table, error)
      call check_contains(content(path), "# "//repeat("x", 200000)//lf//"time"//lf, "long line")
   end subroutine test_csv_comments

   !> A grid as CSV has its coordinates as columns
   subroutine test_csv_grid()
      type(error_t), allocatable :: error
      type(table_t) :: table
      character(len=:), allocatable :: path

      path = join_path(folder, "grid.csv")
      call new_table(table, "summary", "grid", "")
      call add_dimension(table, column_of("material", ["a ", "bc"], "", "material"))
      call add_dimension(table, column_of("k", [7, 8], "1", "number"))
      call add_column(table, column_of("n", [1, 2, 3, 4], "1", "count"))
      call write_csv(path, table, error)
      call check(.not. allocated(error), "grid can be written as csv")
      call check_contains(content(path), "material,k,n"//lf//"a,7,1"//lf//"a,8,2"//lf// &
         & "bc,7,3"//lf//"bc,8,4"//lf, "csv of a grid")
   end subroutine test_csv_grid

   !> HDF5 files; that others read them is a test in Python
   subroutine test_hdf5()
      type(error_t), allocatable :: error
      type(table_t) :: history, table
      character(len=:), allocatable :: first, path
      character(len=*), parameter :: signature = char(137)//"HDF"//cr//lf//achar(26)//lf

      path = join_path(folder, "small.h5")
      call new_table(history, "history", "small", "case")
      call add_dimension(history, column_of("time", [0.0_wp, 1.0e-6_wp, 2.0e-6_wp], "s", "time"))
      call add_column(history, column_of("force", [0.0_wp, 1.0_wp, 0.5_wp], "N", "force"))
      call write_hdf5(path, [small_table(), history], error)
      call check(.not. allocated(error), "tables can be written as hdf5")
      first = content(path)
      call check(index(first, signature) == 1, "file is hdf5")
      call check_contains(first, "coefficient of restitution", "file has what names mean")
      call write_hdf5(path, [small_table(), history], error)
      call check(content(path) == first, "the same tables give the same bytes")

      call write_hdf5(path, [small_table()], error)
      call check(.not. allocated(error), "hdf5 without history")
      call check(index(content(path), "history") == 0, "no history, no group")

      call new_table(table, "summary", "none", "")
      call add_dimension(table, "impact", 0)
      call add_column(table, column_of("status", [character(len=3) ::], "", "status"))
      call write_hdf5(path, [table], error)
      call check(.not. allocated(error), "hdf5 of a table without rows")

      ! Names that HDF5 would take for its own
      call new_table(table, "summary", "names", "")
      call add_dimension(table, "impact", 1)
      call add_column(table, column_of("a/b.c", [1], "1", "slash"))
      call write_hdf5(path, [table], error)
      call check(.not. allocated(error), "name with a slash")
      first = content(path)
      call add_column(table, column_of("a_b.c", [1], "1", "no slash"))
      call write_hdf5(path, [table], error)
      call check_failed(error, "HDF5 cannot create 'a_b.c'", "names that differ in a slash only")
      call check(content(path) == first, "a failure of HDF5 leaves the old file")

      call large_table(table)
      call write_hdf5(path, [table], error)
      call check(.not. allocated(error), "large table can be written as hdf5")
   end subroutine test_hdf5

   !> A table of two rows with one column of each kind
   function small_table() result(table)
      !> The table
      type(table_t) :: table

      call new_table(table, "summary", "small", "&case"//lf//"  title = 'small'"//lf//"/"//lf)
      call add_dimension(table, "impact", 2)
      call add_column(table, column_of("cor", [0.5_wp, ieee_value(1.0_wp, ieee_quiet_nan)], "1", &
         & "coefficient of restitution"))
      call add_column(table, column_of("""rubber, soft"".beta", [-3, 0], "s-1", "rate"))
      call add_column(table, column_of("status", ["a, ""b""", "      "], "", "how it ended"))
   end function small_table

   !> A table with many rows
   subroutine large_table(table)
      !> The table
      type(table_t), intent(out) :: table
      integer, parameter :: rows = 20000
      character(len=4), allocatable :: words(:)
      integer :: i

      allocate(words(rows))
      words = "word"
      call new_table(table, "summary", "large", "")
      call add_dimension(table, "impact", rows)
      call add_column(table, column_of("cor", [(1.0_wp/i, i = 1, rows)], "1", "cor"))
      call add_column(table, column_of("status", words, "", "status"))
   end subroutine large_table

   !> Check that there is an error about a file, on one line
   subroutine check_failed(error, part, what)
      !> Error to check
      type(error_t), allocatable, intent(in) :: error
      !> What its message holds
      character(len=*), intent(in) :: part
      !> What was wrong
      character(len=*), intent(in) :: what

      call check(allocated(error), what//": is an error")
      if (.not. allocated(error)) return
      call check(error%code == error_file, what//": is an error of files")
      call check_contains(error%message, part, what//": message")
      call check(index(error%message, lf) == 0, what//": message has one line")
   end subroutine check_failed

   !> Check how many temporary files there are
   subroutine check_temporaries(expected, what)
      !> How many there should be
      integer, intent(in) :: expected
      !> When
      character(len=*), intent(in) :: what
      integer :: code

      call execute_command_line("test $(ls -A "//quoted_path(folder)//" | grep -c '[.]tmp$') = " &
         & //integer_text(expected), exitstat=code)
      call check(code == 0, "number of temporary files "//what)
   end subroutine check_temporaries

   !> All bytes of a file
   function content(path) result(text)
      !> Path of the file
      character(len=*), intent(in) :: path
      !> Its bytes; empty if it cannot be read
      character(len=:), allocatable :: text
      integer :: length, status, unit

      text = ""
      open(newunit=unit, file=path, status="old", action="read", access="stream", &
         & form="unformatted", iostat=status)
      if (status /= 0) return
      inquire(unit=unit, size=length)
      deallocate(text)
      allocate(character(len=length) :: text)
      read(unit, iostat=status) text
      if (status /= 0) text = ""
      close(unit)
   end function content

   !> A real number as `put_real` writes it
   function decimal_text(x) result(text)
      !> Any number, including NaN and infinity
      real(wp), intent(in) :: x
      !> Its text, 17 digits
      character(len=:), allocatable :: text
      type(decimal_t) :: decimal
      character(len=longest_real) :: buffer
      integer :: last

      call new_decimal(decimal)
      last = 0
      call put_real(decimal, x, buffer, last)
      text = buffer(:last)
   end function decimal_text

end program test_output
