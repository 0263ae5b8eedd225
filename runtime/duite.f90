! duite for Fortran 2018: duite.h by iso_c_binding. Names, arguments and codes are those of the C header and of its man
! pages; parameters of a body and forks of a graph are counted from 0, as there. A compiled module is one compiler's, so
! this file is compiled with the program:
!
!     gfortran -c $(pkg-config --variable=fortran duite)
!     gfortran program.f90 duite.o $(pkg-config --libs duite)
!
! A body is a function of the interface duite_body. Kernels stand in one array, a `target` that stays in place, and
! duite_start gets all of it: the runtime knows a kernel by its address. Texts that go to C end with c_null_char, but for
! those of duite_kernel_of and duite_fail. Functions whose code nobody needs are called all the same:
! code = duite_new(...); the next duite_get, duite_wait or duite_stop returns the first error.
module duite
    use, intrinsic :: iso_c_binding
    implicit none
    private :: text_of, text_for

    integer(c_int), parameter :: DUITE_MAX_ACCESS = 64, DUITE_MAX_THREADS = 4096

    integer(c_int), parameter :: DUITE_OK = 0, DUITE_E_ARGUMENT = -1, DUITE_E_MEMORY = -2, DUITE_E_OBJECT = -3, &
        DUITE_E_KERNEL = -4, DUITE_E_ACCESS = -5, DUITE_E_MPI = -6, DUITE_E_DIFFERENT = -7, DUITE_E_STATE = -8, &
        DUITE_E_NOT_FREED = -9, DUITE_E_SYSTEM = -10, DUITE_E_RIGHT = -11, DUITE_E_LAW = -12, DUITE_E_BINDING = -13, &
        DUITE_E_SIZE = -14, DUITE_E_CHECK = -15, DUITE_E_LOST = -17, DUITE_E_DEPTH = -18

    integer(c_int), parameter :: DUITE_BYTE = 1, DUITE_I32 = 2, DUITE_I64 = 3, DUITE_F32 = 4, DUITE_F64 = 5, &
        DUITE_I8 = 6, DUITE_I16 = 7, DUITE_U8 = 8, DUITE_U16 = 9, DUITE_U32 = 10, DUITE_U64 = 11, DUITE_CF32 = 12, &
        DUITE_CF64 = 13

    integer(c_int), parameter :: DUITE_NONE = 0, DUITE_R = 1, DUITE_W = 2, DUITE_RW = 3, DUITE_CW = 4, DUITE_RP = 5, DUITE_WP = 6, &
        DUITE_RWP = 7, DUITE_CWP = 8

    type, bind(C) :: duite_object
        integer(c_int32_t) :: slot = 0, generation = 0
    end type
    type, bind(C) :: duite_graph
        integer(c_int32_t) :: slot = 0, generation = 0
    end type
    type, bind(C) :: duite_event
        integer(c_int32_t) :: slot = 0, generation = 0
    end type

    type, bind(C) :: duite_law
        type(c_ptr) :: name = c_null_ptr
        integer(c_int) :: type = 0
        type(c_funptr) :: neutral = c_null_funptr, combine = c_null_funptr
    end type

    type, bind(C) :: duite_param
        type(c_ptr) :: data
        integer(c_size_t) :: count
        integer(c_int) :: type
        integer(c_size_t) :: max
        type(duite_object) :: object
    end type

    type, bind(C) :: duite_call
        type(c_ptr) :: args, context, rt, param
        integer(c_size_t) :: n_params
        integer(c_int64_t) :: round
        integer(c_int) :: rank, worker
        type(c_ptr) :: own
    end type

    type, bind(C) :: duite_kernel
        type(c_ptr) :: name = c_null_ptr
        type(c_funptr) :: body = c_null_funptr
        integer(c_int8_t) :: access(DUITE_MAX_ACCESS) = 0_c_int8_t ! DUITE_NONE
        integer(c_int) :: variadic = DUITE_NONE
        integer(c_size_t) :: args_size = 0
        integer(c_int) :: side_effects = 0, fixed = 0
        type(c_ptr) :: law = c_null_ptr
        type(c_ptr) :: variadic_law = c_null_ptr
        integer(c_int) :: replicated = 0, events = 0
    end type

    type, bind(C) :: duite_options
        integer(c_size_t) :: size
        integer(c_intptr_t) :: comm ! by duite_options_comm
        type(c_ptr) :: kernels, laws, context
        integer(c_int) :: threads
        type(c_ptr) :: scheduler, mapping, balance
        integer(c_int64_t) :: seed
        real(c_double) :: spin_seconds
        integer(c_int) :: bind
        integer(c_size_t) :: window
        real(c_double) :: stuck_seconds, lost_seconds
        type(c_ptr) :: trace
        integer(c_int64_t) :: trace_first, trace_end
        integer(c_int) :: check, memo
        type(c_ptr) :: report
    end type

    type, bind(C) :: duite_task_options
        type(c_ptr) :: at = c_null_ptr
        integer(c_int32_t) :: priority = 0
        real(c_double) :: cost = 0
    end type

    type, bind(C) :: duite_counters
        integer(c_int64_t) :: tasks, placed, stolen, chained, messages, bytes
        real(c_double) :: busy, idle
        integer(c_int64_t) :: graphs_recorded, delegated
        real(c_double) :: awaited, exposed
        integer(c_int64_t) :: migrated, stolen_far, recognised, recognised_rounds
    end type

    abstract interface
        integer(c_int) function duite_body(call) bind(C)
            import :: c_int, duite_call
            type(duite_call), intent(in) :: call
        end function
        integer(c_int) function duite_build(rt, context) bind(C)
            import :: c_int, c_ptr
            type(c_ptr), value :: rt, context
        end function
    end interface

    ! ---- Functions of duite.h ----

    interface
        integer(c_int) function duite_version() bind(C, name='duite_version')
            import :: c_int
        end function
        integer(c_int) function duite_stop(rt) bind(C, name='duite_stop')
            import :: c_int, c_ptr
            type(c_ptr), intent(inout) :: rt
        end function
        integer(c_int) function duite_abandon(rt) bind(C, name='duite_abandon')
            import :: c_int, c_ptr
            type(c_ptr), intent(inout) :: rt
        end function
        integer(c_int) function duite_options_comm(options, comm) bind(C, name='duite_options_comm')
            import :: c_int, duite_options
            type(duite_options), intent(inout) :: options
            integer(c_int), value :: comm ! of mpi, or comm%mpi_val of mpi_f08
        end function
        integer(c_int) function duite_mpi_begin(rt) bind(C, name='duite_mpi_begin')
            import :: c_int, c_ptr
            type(c_ptr), value :: rt
        end function
        integer(c_int) function duite_mpi_end(rt) bind(C, name='duite_mpi_end')
            import :: c_int, c_ptr
            type(c_ptr), value :: rt
        end function
        integer(c_int) function duite_rank(rt) bind(C, name='duite_rank')
            import :: c_int, c_ptr
            type(c_ptr), value :: rt
        end function
        integer(c_int) function duite_ranks(rt) bind(C, name='duite_ranks')
            import :: c_int, c_ptr
            type(c_ptr), value :: rt
        end function
        integer(c_int) function duite_threads(rt) bind(C, name='duite_threads')
            import :: c_int, c_ptr
            type(c_ptr), value :: rt
        end function
        integer(c_int) function duite_cores(rt, from) bind(C, name='duite_cores')
            import :: c_int, c_ptr
            type(c_ptr), value :: rt, from ! c_null_ptr, or c_loc of a type(c_ptr)
        end function
        integer(c_int) function duite_oversubscribed(rt) bind(C, name='duite_oversubscribed')
            import :: c_int, c_ptr
            type(c_ptr), value :: rt
        end function
        type(c_ptr) function duite_scheduler_find(name) bind(C, name='duite_scheduler_find')
            import :: c_ptr, c_char
            character(kind=c_char), intent(in) :: name(*)
        end function
        type(c_ptr) function duite_mapping_find(name) bind(C, name='duite_mapping_find')
            import :: c_ptr, c_char
            character(kind=c_char), intent(in) :: name(*)
        end function
        type(c_ptr) function duite_balancer_find(name) bind(C, name='duite_balancer_find')
            import :: c_ptr, c_char
            character(kind=c_char), intent(in) :: name(*)
        end function
        type(c_ptr) function duite_law_find(name) bind(C, name='duite_law_find')
            import :: c_ptr, c_char
            character(kind=c_char), intent(in) :: name(*)
        end function

        integer(c_int) function duite_new(rt, type, count, object) bind(C, name='duite_new')
            import :: c_int, c_ptr, c_size_t, duite_object
            type(c_ptr), value :: rt
            integer(c_int), value :: type
            integer(c_size_t), value :: count
            type(duite_object), intent(out) :: object
        end function
        integer(c_int) function duite_new_sized(rt, type, count, max, object) bind(C, name='duite_new_sized')
            import :: c_int, c_ptr, c_size_t, duite_object
            type(c_ptr), value :: rt
            integer(c_int), value :: type
            integer(c_size_t), value :: count, max
            type(duite_object), intent(out) :: object
        end function
        integer(c_int) function duite_free(rt, object) bind(C, name='duite_free')
            import :: c_int, c_ptr, duite_object
            type(c_ptr), value :: rt
            type(duite_object), value :: object
        end function
        integer(c_int) function duite_set(rt, object, values) bind(C, name='duite_set')
            import :: c_int, c_ptr, duite_object
            type(c_ptr), value :: rt
            type(duite_object), value :: object
            type(*), intent(in), optional :: values(*) ! left out: zeros
        end function
        integer(c_int) function duite_set_sized(rt, object, values, count) bind(C, name='duite_set_sized')
            import :: c_int, c_ptr, c_size_t, duite_object
            type(c_ptr), value :: rt
            type(duite_object), value :: object
            type(*), intent(in) :: values(*)
            integer(c_size_t), value :: count
        end function
        integer(c_int) function duite_get(rt, object, values) bind(C, name='duite_get')
            import :: c_int, c_ptr, duite_object
            type(c_ptr), value :: rt
            type(duite_object), value :: object
            type(*), intent(inout) :: values(*)
        end function
        integer(c_int) function duite_get_begin(rt, object, values) bind(C, name='duite_get_begin')
            import :: c_int, c_ptr, duite_object
            type(c_ptr), value :: rt
            type(duite_object), value :: object
            type(c_ptr), value :: values ! c_loc of a target, which is the runtime's until the end
        end function
        integer(c_int) function duite_get_end(rt, object) bind(C, name='duite_get_end')
            import :: c_int, c_ptr, duite_object
            type(c_ptr), value :: rt
            type(duite_object), value :: object
        end function
        integer(c_int) function duite_get_at(rt, object, rank, values) bind(C, name='duite_get_at')
            import :: c_int, c_ptr, duite_object
            type(c_ptr), value :: rt
            type(duite_object), value :: object
            integer(c_int), value :: rank
            type(*), intent(inout) :: values(*)
        end function
        integer(c_int) function duite_get_count(rt, object, count) bind(C, name='duite_get_count')
            import :: c_int, c_ptr, c_size_t, duite_object
            type(c_ptr), value :: rt
            type(duite_object), value :: object
            integer(c_size_t), intent(inout) :: count
        end function
        integer(c_int) function duite_acquire(rt, object, mode, data) bind(C, name='duite_acquire')
            import :: c_int, c_ptr, duite_object
            type(c_ptr), value :: rt
            type(duite_object), value :: object
            integer(c_int), value :: mode
            type(c_ptr), intent(out) :: data ! for c_f_pointer, where it is associated
        end function
        integer(c_int) function duite_release(rt, object) bind(C, name='duite_release')
            import :: c_int, c_ptr, duite_object
            type(c_ptr), value :: rt
            type(duite_object), value :: object
        end function
        integer(c_int) function duite_adopt(rt, rank, type, count, values, done, user, object) bind(C, name='duite_adopt')
            import :: c_int, c_ptr, c_funptr, c_size_t, duite_object
            type(c_ptr), value :: rt
            integer(c_int), value :: rank, type
            integer(c_size_t), value :: count
            type(c_ptr), value :: values ! c_loc of an array; on other ranks c_null_ptr
            type(c_funptr), value :: done ! or c_null_funptr
            type(c_ptr), value :: user
            type(duite_object), intent(out) :: object
        end function
        integer(c_int) function duite_set_at(rt, object, rank, values) bind(C, name='duite_set_at')
            import :: c_int, c_ptr, duite_object
            type(c_ptr), value :: rt
            type(duite_object), value :: object
            integer(c_int), value :: rank
            type(*), intent(in), optional :: values(*)
        end function
        integer(c_int) function duite_split(rt, object, n, counts, parts) bind(C, name='duite_split')
            import :: c_int, c_ptr, c_size_t, duite_object
            type(c_ptr), value :: rt
            type(duite_object), value :: object
            integer(c_size_t), value :: n
            integer(c_size_t), intent(in) :: counts(*)
            type(duite_object), intent(inout) :: parts(*)
        end function
        integer(c_int) function duite_join(rt, object) bind(C, name='duite_join')
            import :: c_int, c_ptr, duite_object
            type(c_ptr), value :: rt
            type(duite_object), value :: object
        end function
        integer(c_int) function duite_hint(rt, object, weight, n, neighbours, edge_weights) bind(C, name='duite_hint')
            import :: c_int, c_ptr, c_size_t, c_double, duite_object
            type(c_ptr), value :: rt
            type(duite_object), value :: object
            real(c_double), value :: weight
            integer(c_size_t), value :: n
            type(duite_object), intent(in) :: neighbours(*)
            real(c_double), intent(in), optional :: edge_weights(*)
        end function
        integer(c_int) function duite_colocate(rt, object, leader) bind(C, name='duite_colocate')
            import :: c_int, c_ptr, duite_object
            type(c_ptr), value :: rt
            type(duite_object), value :: object, leader
        end function
        integer(c_int) function duite_home(rt, object) bind(C, name='duite_home')
            import :: c_int, c_ptr, duite_object
            type(c_ptr), value :: rt
            type(duite_object), value :: object
        end function
        integer(c_int) function duite_is_local(rt, object) bind(C, name='duite_is_local')
            import :: c_int, c_ptr, duite_object
            type(c_ptr), value :: rt
            type(duite_object), value :: object
        end function
        subroutine duite_prefetch(rt, n, objects) bind(C, name='duite_prefetch')
            import :: c_ptr, c_size_t, duite_object
            type(c_ptr), value :: rt
            integer(c_size_t), value :: n
            type(duite_object), intent(in) :: objects(*)
        end subroutine

        integer(c_int) function duite_kernel_add(rt, kernel) bind(C, name='duite_kernel_add')
            import :: c_int, c_ptr, duite_kernel
            type(c_ptr), value :: rt
            type(duite_kernel), intent(in), target :: kernel ! stays in place
        end function
        integer(c_int) function duite_fork_at(rt, rank, kernel, args, n, objects) bind(C, name='duite_fork_at')
            import :: c_int, c_ptr, c_size_t, duite_object, duite_kernel
            type(c_ptr), value :: rt, args
            integer(c_int), value :: rank
            type(duite_kernel), intent(in), target :: kernel
            integer(c_size_t), value :: n
            type(duite_object), intent(in) :: objects(*)
        end function
        integer(c_int) function duite_fork_with(rt, options, kernel, args, n, objects) bind(C, name='duite_fork_with')
            import :: c_int, c_ptr, c_size_t, duite_object, duite_kernel, duite_task_options
            type(c_ptr), value :: rt, args
            type(duite_task_options), intent(in) :: options
            type(duite_kernel), intent(in), target :: kernel
            integer(c_size_t), value :: n
            type(duite_object), intent(in) :: objects(*)
        end function
        integer(c_int) function duite_wait(rt) bind(C, name='duite_wait')
            import :: c_int, c_ptr
            type(c_ptr), value :: rt
        end function
        integer(c_int) function duite_wait_for(rt, n, objects) bind(C, name='duite_wait_for')
            import :: c_int, c_ptr, c_size_t, duite_object
            type(c_ptr), value :: rt
            integer(c_size_t), value :: n
            type(duite_object), intent(in) :: objects(*)
        end function
        integer(c_int) function duite_test(rt, n, objects, there) bind(C, name='duite_test')
            import :: c_int, c_ptr, c_size_t, duite_object
            type(c_ptr), value :: rt
            integer(c_size_t), value :: n
            type(duite_object), intent(in) :: objects(*)
            integer(c_int), intent(out) :: there
        end function

        integer(c_int) function duite_replay(rt, graph, rounds) bind(C, name='duite_replay')
            import :: c_int, c_ptr, c_int64_t, duite_graph
            type(c_ptr), value :: rt
            type(duite_graph), value :: graph
            integer(c_int64_t), value :: rounds
        end function
        integer(c_int) function duite_replay_while(rt, graph, flag, max_rounds) bind(C, name='duite_replay_while')
            import :: c_int, c_ptr, c_int64_t, duite_graph, duite_object
            type(c_ptr), value :: rt
            type(duite_graph), value :: graph
            type(duite_object), value :: flag
            integer(c_int64_t), value :: max_rounds
        end function
        integer(c_int) function duite_graph_rounds(rt, graph, rounds) bind(C, name='duite_graph_rounds')
            import :: c_int, c_ptr, c_int64_t, duite_graph
            type(c_ptr), value :: rt
            type(duite_graph), value :: graph
            integer(c_int64_t), intent(inout) :: rounds
        end function
        integer(c_int) function duite_graph_args(rt, graph, k, args) bind(C, name='duite_graph_args')
            import :: c_int, c_ptr, c_size_t, duite_graph
            type(c_ptr), value :: rt, args
            type(duite_graph), value :: graph
            integer(c_size_t), value :: k
        end function
        integer(c_int) function duite_graph_bind(rt, graph, recorded, object) bind(C, name='duite_graph_bind')
            import :: c_int, c_ptr, duite_graph, duite_object
            type(c_ptr), value :: rt
            type(duite_graph), value :: graph
            type(duite_object), value :: recorded, object
        end function
        integer(c_int) function duite_graph_free(rt, graph) bind(C, name='duite_graph_free')
            import :: c_int, c_ptr, duite_graph
            type(c_ptr), value :: rt
            type(duite_graph), value :: graph
        end function

        integer(c_int) function duite_resize(call, i, count) bind(C, name='duite_resize')
            import :: c_int, c_size_t, duite_call
            type(duite_call), intent(in) :: call
            integer(c_size_t), value :: i, count
        end function
        type(c_ptr) function duite_contribute(call, i) bind(C, name='duite_contribute')
            import :: c_ptr, c_size_t, duite_call
            type(duite_call), intent(in) :: call
            integer(c_size_t), value :: i
        end function
        integer(c_int) function duite_event_new(call, event) bind(C, name='duite_event_new')
            import :: c_int, duite_call, duite_event
            type(duite_call), intent(in) :: call
            type(duite_event), intent(out) :: event
        end function
        integer(c_int) function duite_await_mpi(call, n, requests) bind(C, name='duite_await_fortran')
            import :: c_int, duite_call
            type(duite_call), intent(in) :: call
            integer(c_int), value :: n
            integer(c_int), intent(inout) :: requests(*) ! of mpi, or requests%mpi_val of mpi_f08
        end function
        integer(c_int) function duite_complete(rt, event, code) bind(C, name='duite_complete')
            import :: c_int, c_ptr, duite_event
            type(c_ptr), value :: rt
            type(duite_event), value :: event
            integer(c_int), value :: code
        end function
        integer(c_int) function duite_trace_step(rt, step) bind(C, name='duite_trace_step')
            import :: c_int, c_ptr, c_int64_t
            type(c_ptr), value :: rt
            integer(c_int64_t), value :: step
        end function
        integer(c_int) function duite_trace_end(rt) bind(C, name='duite_trace_end')
            import :: c_int, c_ptr
            type(c_ptr), value :: rt
        end function
    end interface

    ! duite_data(call, i, x): x becomes the elements of parameter i of a body's call.
    interface duite_data
        module procedure data_f64, data_f32, data_i64, data_i32, data_cf64
    end interface
    private :: data_f64, data_f32, data_i64, data_i32, data_cf64

contains

    ! ---- In the manner of Fortran ----

    function text_of(pointer) result(text)
        type(c_ptr), intent(in) :: pointer
        character(:), allocatable :: text
        character(kind=c_char), pointer :: each(:)
        integer :: i
        interface
            integer(c_size_t) function c_length(text) bind(C, name='strlen')
                import :: c_ptr, c_size_t
                type(c_ptr), value :: text
            end function
        end interface
        call c_f_pointer(pointer, each, [c_length(pointer)])
        allocate (character(size(each)) :: text)
        do i = 1, size(each)
            text(i:i) = each(i)
        end do
    end function

    ! A text for C that lasts as long as the program.
    function text_for(text) result(pointer)
        character(*), intent(in) :: text
        type(c_ptr) :: pointer
        character(kind=c_char), pointer :: each(:)
        integer :: i
        allocate (each(len(text) + 1))
        do i = 1, len(text)
            each(i) = text(i:i)
        end do
        each(len(text) + 1) = c_null_char
        pointer = c_loc(each)
    end function

    function duite_message() result(text)
        character(:), allocatable :: text
        interface
            type(c_ptr) function c_message() bind(C, name='duite_message')
                import :: c_ptr
            end function
        end interface
        text = text_of(c_message())
    end function

    function duite_code_text(code) result(text)
        integer(c_int), intent(in) :: code
        character(:), allocatable :: text
        interface
            type(c_ptr) function c_code_text(code) bind(C, name='duite_code_text')
                import :: c_ptr, c_int
                integer(c_int), value :: code
            end function
        end interface
        text = text_of(c_code_text(code))
    end function

    ! For `code = duite_fail(call, 1, 'why')`, which the body then returns.
    integer(c_int) function duite_fail(call, code, text)
        type(duite_call), intent(in) :: call
        integer, intent(in) :: code
        character(*), intent(in) :: text
        interface
            integer(c_int) function c_fail(call, code, text) bind(C, name='duite_fail_text')
                import :: c_int, c_char, duite_call
                type(duite_call), intent(in) :: call
                integer(c_int), value :: code
                character(kind=c_char), intent(in) :: text(*)
            end function
        end interface
        duite_fail = c_fail(call, int(code, c_int), text // c_null_char)
    end function

    type(duite_options) function duite_options_default() result(options)
        integer(c_int) :: code
        interface
            integer(c_int) function c_options_set(options, size) bind(C, name='duite_options_set')
                import :: c_int, c_size_t, duite_options
                type(duite_options), intent(out) :: options
                integer(c_size_t), value :: size
            end function
        end interface
        code = c_options_set(options, c_sizeof(options))
        if (code /= DUITE_OK) options%size = 0 ! which duite_start refuses
    end function

    ! access: modes of the parameters; laws: those of the parameters under DUITE_CW and DUITE_CWP, c_null_ptr for the others
    ! and for a sum. Further components are set in the kernel itself.
    function duite_kernel_of(name, body, access, args_size, laws) result(kernel)
        character(*), intent(in) :: name
        procedure(duite_body) :: body
        integer(c_int), intent(in) :: access(:)
        integer(c_size_t), intent(in), optional :: args_size
        type(c_ptr), intent(in), optional :: laws(:)
        type(duite_kernel) :: kernel
        type(c_ptr), pointer :: law(:) ! lasts as long as the program
        kernel%name = text_for(name)
        kernel%body = c_funloc(body)
        kernel%access(1:size(access)) = int(access, c_int8_t)
        if (present(args_size)) kernel%args_size = args_size
        if (.not. present(laws)) return
        allocate (law(size(access)))
        law = c_null_ptr
        law(1:size(laws)) = laws
        kernel%law = c_loc(law)
    end function

    ! kernels: all of the program, in place of options%kernels.
    integer(c_int) function duite_start(rt, kernels, options)
        type(c_ptr), intent(out) :: rt
        type(duite_kernel), intent(in), target :: kernels(:)
        type(duite_options), intent(in), optional :: options
        type(duite_options) :: whole
        type(c_ptr), target :: list(size(kernels) + 1)
        integer :: i
        interface
            integer(c_int) function c_start(rt, options) bind(C, name='duite_start')
                import :: c_int, c_ptr, duite_options
                type(c_ptr), intent(out) :: rt
                type(duite_options), intent(in) :: options
            end function
        end interface
        whole = duite_options_default()
        if (present(options)) whole = options
        do i = 1, size(kernels)
            list(i) = c_loc(kernels(i))
        end do
        list(size(list)) = c_null_ptr
        whole%kernels = c_loc(list)
        duite_start = c_start(rt, whole)
    end function

    ! args: c_loc of the arguments, which are copied.
    integer(c_int) function duite_fork(rt, kernel, objects, args)
        type(c_ptr), intent(in) :: rt
        type(duite_kernel), intent(in), target :: kernel
        type(duite_object), intent(in) :: objects(:)
        type(c_ptr), intent(in), optional :: args
        type(c_ptr) :: copied
        interface
            integer(c_int) function c_fork(rt, kernel, args, n, objects) bind(C, name='duite_fork')
                import :: c_int, c_ptr, c_size_t, duite_object, duite_kernel
                type(c_ptr), value :: rt, args
                type(duite_kernel), intent(in), target :: kernel
                integer(c_size_t), value :: n
                type(duite_object), intent(in) :: objects(*)
            end function
        end interface
        copied = c_null_ptr
        if (present(args)) copied = args
        duite_fork = c_fork(rt, kernel, copied, int(size(objects), c_size_t), objects)
    end function

    integer(c_int) function duite_graph_new(rt, build, context, graph)
        type(c_ptr), intent(in) :: rt, context
        procedure(duite_build) :: build
        type(duite_graph), intent(out) :: graph
        interface
            integer(c_int) function c_graph_new(rt, build, context, graph) bind(C, name='duite_graph_new')
                import :: c_int, c_ptr, c_funptr, duite_graph
                type(c_ptr), value :: rt, context
                type(c_funptr), value :: build
                type(duite_graph), intent(out) :: graph
            end function
        end interface
        duite_graph_new = c_graph_new(rt, c_funloc(build), context, graph)
    end function

    integer(c_int) function duite_count_all(rt, counters)
        type(c_ptr), intent(in) :: rt
        type(duite_counters), intent(inout) :: counters
        interface
            integer(c_int) function c_count(rt, counters, size) bind(C, name='duite_count_sized')
                import :: c_int, c_ptr, c_size_t, duite_counters
                type(c_ptr), value :: rt
                type(duite_counters), intent(inout) :: counters
                integer(c_size_t), value :: size
            end function
        end interface
        duite_count_all = c_count(rt, counters, c_sizeof(counters))
    end function

    ! Parameter i of a call.
    function duite_parameter(call, i) result(parameter)
        type(duite_call), intent(in) :: call
        integer, intent(in) :: i
        type(duite_param), pointer :: parameter
        type(duite_param), pointer :: all(:)
        call c_f_pointer(call%param, all, [call%n_params])
        parameter => all(i + 1)
    end function

    subroutine data_f64(call, i, x)
        type(duite_call), intent(in) :: call
        integer, intent(in) :: i
        real(c_double), pointer, intent(out) :: x(:)
        type(duite_param), pointer :: parameter
        parameter => duite_parameter(call, i)
        call c_f_pointer(parameter%data, x, [parameter%count])
    end subroutine

    subroutine data_f32(call, i, x)
        type(duite_call), intent(in) :: call
        integer, intent(in) :: i
        real(c_float), pointer, intent(out) :: x(:)
        type(duite_param), pointer :: parameter
        parameter => duite_parameter(call, i)
        call c_f_pointer(parameter%data, x, [parameter%count])
    end subroutine

    subroutine data_i64(call, i, x)
        type(duite_call), intent(in) :: call
        integer, intent(in) :: i
        integer(c_int64_t), pointer, intent(out) :: x(:)
        type(duite_param), pointer :: parameter
        parameter => duite_parameter(call, i)
        call c_f_pointer(parameter%data, x, [parameter%count])
    end subroutine

    subroutine data_i32(call, i, x)
        type(duite_call), intent(in) :: call
        integer, intent(in) :: i
        integer(c_int32_t), pointer, intent(out) :: x(:)
        type(duite_param), pointer :: parameter
        parameter => duite_parameter(call, i)
        call c_f_pointer(parameter%data, x, [parameter%count])
    end subroutine

    subroutine data_cf64(call, i, x)
        type(duite_call), intent(in) :: call
        integer, intent(in) :: i
        complex(c_double_complex), pointer, intent(out) :: x(:)
        type(duite_param), pointer :: parameter
        parameter => duite_parameter(call, i)
        call c_f_pointer(parameter%data, x, [parameter%count])
    end subroutine
end module
