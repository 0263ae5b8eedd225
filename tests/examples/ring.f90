! Rows of numbers that go once round all ranks, as in ring.c: a task begins the program's own messages, and ends when they
! are over.
module ring_bodies
    use duite
    use mpi_f08
    implicit none

    integer, parameter :: LENGTH = 1000, PASS = 1, GROW = 2
    type(duite_kernel), target, save :: kernel(2)

contains

    ! Sends parameter 0 to the next rank; parameter 1 comes from the one before.
    integer(c_int) function pass_row(call) bind(C) result(code)
        type(duite_call), intent(in) :: call
        real(c_double), pointer :: given(:), got(:)
        type(MPI_Request) :: request(2)
        integer :: ranks
        ranks = duite_ranks(call%rt)
        call duite_data(call, 0, given)
        call duite_data(call, 1, got)
        code = duite_mpi_begin(call%rt)
        if (code /= DUITE_OK) return
        call MPI_Irecv(got, LENGTH, MPI_DOUBLE_PRECISION, modulo(call%rank - 1, ranks), 0, MPI_COMM_WORLD, request(1))
        call MPI_Isend(given, LENGTH, MPI_DOUBLE_PRECISION, modulo(call%rank + 1, ranks), 0, MPI_COMM_WORLD, request(2))
        code = duite_mpi_end(call%rt)
        if (code == DUITE_OK) code = duite_await_mpi(call, 2, request%mpi_val)
        if (any(request%mpi_val /= MPI_REQUEST_NULL%mpi_val)) code = duite_fail(call, 1, 'a request was not handed over')
    end function

    integer(c_int) function grow_row(call) bind(C) result(code)
        type(duite_call), intent(in) :: call
        real(c_double), pointer :: row(:), next(:)
        call duite_data(call, 0, row)
        call duite_data(call, 1, next)
        next = row + 1
        code = DUITE_OK
    end function
end module

program ring
    use ring_bodies
    implicit none

    type(c_ptr) :: rt
    type(duite_object), allocatable :: row(:), next(:)
    real(c_double) :: got(LENGTH)
    integer(c_int) :: code
    integer :: r, step, i
    logical :: wrong

    kernel(PASS) = duite_kernel_of('pass', pass_row, [DUITE_R, DUITE_W])
    kernel(PASS)%events = 1
    kernel(GROW) = duite_kernel_of('grow', grow_row, [DUITE_R, DUITE_W])
    if (duite_start(rt, kernel) /= DUITE_OK) call give_up()
    allocate (row(0:duite_ranks(rt) - 1), next(0:duite_ranks(rt) - 1))
    do r = 0, ubound(row, 1)
        code = duite_new(rt, DUITE_F64, int(LENGTH, c_size_t), row(r))
        code = duite_new(rt, DUITE_F64, int(LENGTH, c_size_t), next(r))
        code = duite_set(rt, row(r), [(real(r * LENGTH + i, c_double), i = 1, LENGTH)])
    end do
    do step = 0, ubound(row, 1)
        do r = 0, ubound(row, 1)
            code = duite_fork_at(rt, r, kernel(PASS), c_null_ptr, 2_c_size_t, [row(r), next(r)])
            code = duite_fork_at(rt, r, kernel(GROW), c_null_ptr, 2_c_size_t, [next(r), row(r)])
        end do
    end do
    wrong = .false.
    do r = 0, ubound(row, 1)
        if (duite_get(rt, row(r), got) /= DUITE_OK) call give_up()
        wrong = wrong .or. any(abs(got - [(r * LENGTH + i + size(row), i = 1, LENGTH)]) > 0)
        code = duite_free(rt, row(r))
        code = duite_free(rt, next(r))
    end do
    if (duite_stop(rt) /= DUITE_OK) call give_up()
    if (wrong) error stop 'ring: wrong'

contains

    subroutine give_up()
        print '(2a)', 'ring: ', duite_message()
        error stop
    end subroutine
end program
