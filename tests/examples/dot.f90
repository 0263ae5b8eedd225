! The dot product of two vectors in blocks, in Fortran: each task adds its block's share to one sum. With x(i) = i and
! y(i) = 2 it is n (n + 1), exactly. Then the same again as a graph that is replayed.
module bodies
    use duite
    implicit none

    integer, parameter :: BLOCKS = 13, LENGTH = 1000, ROUNDS = 5
    integer, parameter :: FILL = 1, DOT = 2, LARGEST = 3

    type, bind(C) :: fill_args
        real(c_double) :: first, step
    end type

    ! The runtime knows kernels by their addresses: they stand in one array that stays in place.
    type(duite_kernel), target, save :: kernel(3)
    type(duite_object), save :: x(BLOCKS), y(BLOCKS), total, most

contains

    ! x(i) = first + step (i - 1)
    integer(c_int) function fill_block(call) bind(C) result(code)
        type(duite_call), intent(in) :: call
        type(fill_args), pointer :: args
        real(c_double), pointer :: x(:)
        integer :: i
        call c_f_pointer(call%args, args)
        call duite_data(call, 0, x)
        x = [(args%first + args%step * (i - 1), i = 1, size(x))]
        code = DUITE_OK
    end function

    ! sum = sum + x . y
    integer(c_int) function dot_blocks(call) bind(C) result(code)
        type(duite_call), intent(in) :: call
        real(c_double), pointer :: x(:), y(:), sum(:)
        integer :: i
        call duite_data(call, 0, x)
        call duite_data(call, 1, y)
        call duite_data(call, 2, sum)
        do i = 1, size(x)
            sum(1) = sum(1) + x(i) * y(i)
        end do
        code = DUITE_OK
    end function

    integer(c_int) function largest_of(call) bind(C) result(code)
        type(duite_call), intent(in) :: call
        real(c_double), pointer :: x(:), most(:)
        call duite_data(call, 0, x)
        call duite_data(call, 1, most)
        code = DUITE_OK
        if (any(x < 0)) code = duite_fail(call, 1, 'a block has a negative element')
        most(1) = max(most(1), maxval(x))
    end function

    ! The forks of a round, for the graph and without it.
    integer(c_int) function all_blocks(rt, context) bind(C) result(code)
        type(c_ptr), value :: rt, context
        type(fill_args), target :: args
        integer :: b
        code = DUITE_E_ARGUMENT
        if (c_associated(context)) return ! it has none
        code = duite_set(rt, total) ! to zero
        do b = 1, BLOCKS
            args = fill_args(first=(b - 1) * LENGTH + 1, step=1)
            code = duite_fork(rt, kernel(FILL), [x(b)], c_loc(args))
            args = fill_args(first=2, step=0)
            code = duite_fork(rt, kernel(FILL), [y(b)], c_loc(args))
            code = duite_fork(rt, kernel(DOT), [x(b), y(b), total])
            code = duite_fork(rt, kernel(LARGEST), [x(b), most])
        end do
    end function
end module

program main
    use bodies
    implicit none

    real(c_double), parameter :: RIGHT = BLOCKS * LENGTH * (BLOCKS * LENGTH + 1)
    type(c_ptr) :: rt
    type(duite_graph) :: round
    real(c_double) :: once(1), again(1), found(1)
    integer(c_int) :: code
    integer :: b

    kernel(FILL) = duite_kernel_of('fill', fill_block, [DUITE_W], c_sizeof(fill_args(0, 0)))
    kernel(DOT) = duite_kernel_of('dot', dot_blocks, [DUITE_R, DUITE_R, DUITE_CW])
    kernel(LARGEST) = duite_kernel_of('largest', largest_of, [DUITE_R, DUITE_CW], &
                                      laws=[c_null_ptr, duite_law_find('max' // c_null_char)])
    if (duite_start(rt, kernel) /= DUITE_OK) call give_up()

    code = duite_new(rt, DUITE_F64, 1_c_size_t, total)
    code = duite_new(rt, DUITE_F64, 1_c_size_t, most)
    do b = 1, BLOCKS
        code = duite_new(rt, DUITE_F64, int(LENGTH, c_size_t), x(b))
        code = duite_new(rt, DUITE_F64, int(LENGTH, c_size_t), y(b))
        code = duite_colocate(rt, y(b), x(b)) ! on the same rank
    end do
    code = all_blocks(rt, c_null_ptr)
    if (duite_get(rt, total, once) /= DUITE_OK) call give_up() ! tells the errors of all calls above, too

    code = duite_graph_new(rt, all_blocks, c_null_ptr, round)
    code = duite_replay(rt, round, int(ROUNDS, c_int64_t))
    if (duite_get(rt, total, again) /= DUITE_OK) call give_up()
    if (duite_get(rt, most, found) /= DUITE_OK) call give_up()
    code = duite_graph_free(rt, round)

    if (duite_rank(rt) == 0) print '(a, i0)', 'dot: ', nint(once(1))
    do b = 1, BLOCKS
        code = duite_free(rt, x(b))
        code = duite_free(rt, y(b))
    end do
    code = duite_free(rt, total)
    code = duite_free(rt, most)
    if (duite_stop(rt) /= DUITE_OK) call give_up() ! tells the errors that nobody asked for
    if (any(abs([once, again, found] - [RIGHT, RIGHT, real(BLOCKS * LENGTH, c_double)]) > 0)) error stop 'dot: wrong'

contains

    subroutine give_up()
        print '(2a)', 'dot: ', duite_message()
        error stop
    end subroutine
end program
