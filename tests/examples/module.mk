# The programs that docs/runtime.md and docs/embedding.md explain, each built and run as a user would. -no-install: no script of libtool starts them.
ASAN_SH += tests/examples/test_examples.sh tests/examples/test_cpp.sh
PLAIN_SH += tests/examples/test_fortran.sh
check_PROGRAMS += tests/examples/dot tests/examples/stencil tests/examples/cholesky tests/examples/cg \
	tests/examples/fib tests/examples/quicksort tests/examples/adopt tests/examples/ring
tests_examples_dot_LDFLAGS = $(AM_LDFLAGS) -no-install
tests_examples_dot_LDADD = libduite.la
tests_examples_stencil_LDFLAGS = $(AM_LDFLAGS) -no-install
tests_examples_stencil_LDADD = libduite.la
tests_examples_cholesky_LDFLAGS = $(AM_LDFLAGS) -no-install
tests_examples_cholesky_LDADD = libduite.la -lm
tests_examples_cg_LDFLAGS = $(AM_LDFLAGS) -no-install
tests_examples_cg_LDADD = libduite.la -lm
tests_examples_fib_LDFLAGS = $(AM_LDFLAGS) -no-install
tests_examples_fib_LDADD = libduite.la
tests_examples_quicksort_LDFLAGS = $(AM_LDFLAGS) -no-install
tests_examples_quicksort_LDADD = libduite.la
tests_examples_adopt_LDFLAGS = $(AM_LDFLAGS) -no-install
tests_examples_adopt_LDADD = libduite.la
tests_examples_ring_LDFLAGS = $(AM_LDFLAGS) -no-install
tests_examples_ring_LDADD = libduite.la $(MPI_LIBS)
EXTRA_DIST += tests/examples/dot.cpp tests/examples/dot.f90 tests/examples/ring.f90 tests/examples/stencil.cpp tests/runtime/front.cpp
