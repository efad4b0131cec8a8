!> Identification of a material from data, or from another model
module vcor_app_fit
   use vcor_app_cli, only : request_t
   use vcor_app_fit_options, only : check_fit
   use vcor_app_fit_screen, only : fit_report, fit_remarks
   use vcor_app_place, only : find_place
   use vcor_app_sampling, only : compare_impacts, sample_model, sampled_t
   use vcor_case_identified, only : material_text
   use vcor_error, only : error_input, error_t, error_usage, raise
   use vcor_fit, only : fit_material, fit_t, samples_t
   use vcor_io_data_file, only : data_file
   use vcor_io_file, only : write_file, write_stdout
   use vcor_io_path, only : same_file
   use vcor_io_sample_file, only : read_samples, reading_t, standard_input
   use vcor_kinds, only : wp
   use vcor_text, only : printable
   implicit none
   private

   public :: fit_data

   !> Poisson's ratio where none is given: that of rubber, which is incompressible
   real(wp), parameter :: incompressible = 0.5_wp

contains

   !> Fit a model, show it and write it
   subroutine fit_data(asked, error)
      type(request_t), intent(in) :: asked
      !> Unallocated on success
      type(error_t), allocatable, intent(out) :: error

      type(request_t) :: request
      type(reading_t) :: reading
      type(sampled_t) :: sampled
      type(samples_t) :: samples
      type(fit_t) :: fit
      character(len=:), allocatable :: source, place, note, path, group, tail
      real(wp) :: density, poisson_ratio

      request = asked
      call check_fit(request%fit, size(request%files), reading, error)
      if (allocated(error)) return
      if (allocated(request%fit%source)) then
         source = request%fit%source
         place = printable(source)
         call sample_model(request, sampled, samples, note, error)
      else
         source = request%files(1)%text
         if (request%range%first > 0.0_wp .or. request%range%last > 0.0_wp &
            .or. request%range%points > 0 .or. size(request%settings) > 0) then
            call raise(error, error_usage, '--from, --to, --points and --set are for ' &
               //'--from-model')
            return
         end if
         call read_samples(samples, source, reading, note, place, error)
         if (source == standard_input) source = 'stdin'
      end if
      if (allocated(error)) return
      call fit_material(fit, request%fit%model, request%fit%terms, request%fit%fixed, samples, &
         error)
      if (allocated(error)) then
         error%message = place//': '//error%message
         return
      end if

      density = request%fit%density
      poisson_ratio = incompressible
      fit%data%name = stem_of(source)
      tail = ''
      if (allocated(request%fit%source)) then
         fit%data%name = sampled%name
         if (.not. density > 0.0_wp) density = sampled%density
         poisson_ratio = sampled%poisson_ratio
         tail = sampled%notes//compare_impacts(sampled, fit%data)
      end if
      if (allocated(request%fit%name)) fit%data%name = request%fit%name
      if (request%fit%poisson_ratio <= incompressible) poisson_ratio = request%fit%poisson_ratio
      group = fit_remarks(fit, source, samples)//material_text(fit%data, density, poisson_ratio, &
         samples%first_time(), samples%last_time())
      if (allocated(request%directory)) then
         call choose_path(request, source, sampled, path, error)
         if (.not. allocated(error)) call write_file(path, group, error)
         if (allocated(error)) return
         tail = tail//'  written '//path//new_line('a')
      end if
      if (request%quiet) return
      if (.not. (request%fit%poisson_ratio <= incompressible .or. allocated(request%fit%source))) &
         tail = tail//'  note: poisson_ratio is taken as 0.5, --poisson-ratio gives another' &
         //new_line('a')
      if (.not. density > 0.0_wp) tail = tail//'  note: the density is not known, --density ' &
         //'gives it'//new_line('a')
      call write_stdout(fit_report(fit, source, note, samples, tail)//group, error)
   end subroutine fit_data

   !> Where the group goes: a file, or a file in a directory
   subroutine choose_path(request, source, sampled, path, error)
      type(request_t), intent(in) :: request
      !> The data file, or the case
      character(len=*), intent(in) :: source
      !> What was sampled, if it was
      type(sampled_t), intent(in) :: sampled
      character(len=:), allocatable, intent(out) :: path
      !> Of code `error_input` if the file is one that was read; unallocated on success
      type(error_t), allocatable, intent(out) :: error

      character(len=:), allocatable :: extension

      call keep_what_was_read(request%directory)
      if (allocated(error)) return
      call find_place(request%directory, stem_of(source)//'_fit', 'nml', path, extension, error)
      if (allocated(error)) return
      path = path//'.nml'
      call keep_what_was_read(path)

   contains

      !> No file that was read is replaced
      subroutine keep_what_was_read(name)
         !> Name of a file
         character(len=*), intent(in) :: name

         integer :: i
         logical :: taken

         if (.not. allocated(request%fit%source)) then
            taken = same_file(name, source)
         else
            taken = same_file(name, sampled%case%source)
            do i = 1, sampled%case%count('material')
               if (.not. taken) taken = same_file(name, data_file(sampled%case, i))
            end do
         end if
         if (taken) call raise(error, error_input, printable(source)//': the material would ' &
            //'replace '//name//': give another --output')
      end subroutine keep_what_was_read
   end subroutine choose_path

   !> Name of a file without folder and ending
   pure function stem_of(path) result(stem)
      character(len=*), intent(in) :: path
      character(len=:), allocatable :: stem

      integer :: mark

      stem = trim(path(index(path, '/', back=.true.) + 1:))
      mark = index(stem, '.', back=.true.)
      if (mark > 1) stem = stem(:mark - 1)
   end function stem_of

end module vcor_app_fit
