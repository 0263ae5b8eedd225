dnl What duite-bench measures duite against; all optional. RIVAL_NAME_MISSING is the package that is missing, or "".
dnl Two OpenMP runtimes: each rival is compiled by the compiler whose own it is, whatever CC is.
AC_DEFUN([DUITE_RIVAL], [
    AM_CONDITIONAL([HAVE_RIVAL_$1], [test "x$2" = xyes])
    AS_IF([test "x$2" = xyes], [duite_rival_missing=], [
        duite_rival_missing="$3"
        duite_rivals_missing="$duite_rivals_missing${duite_rivals_missing:+; }$3: no figures against $4"])
    AC_DEFINE_UNQUOTED([RIVAL_$1_MISSING], ["$duite_rival_missing"], [the package that this rival lacks])])

dnl DUITE_TRY_OPENMP(COMPILER, FLAG): sets duite_found to yes if it makes programs with OpenMP tasks.
AC_DEFUN([DUITE_TRY_OPENMP], [
    AC_MSG_CHECKING([whether ${$1:-no compiler} $2 makes programs])
    duite_found=no
    AC_LANG_CONFTEST([AC_LANG_PROGRAM([#include <omp.h>], [[
        int x = 0;
        #pragma omp task depend(inout: x)
        x = omp_get_max_threads() < 1;
        return x;]])])
    AS_IF([test -n "$$1" && $$1 $2 -o conftest$EXEEXT conftest.c >&AS_MESSAGE_LOG_FD 2>&1], [duite_found=yes])
    rm -f conftest.c conftest$EXEEXT
    AC_MSG_RESULT([$duite_found])])

dnl Task Bench's core, on which an adapter of ours is built where DIR has it.
AC_DEFUN([DUITE_TASKBENCH], [
    AC_ARG_WITH([taskbench], [AS_HELP_STRING([--with-taskbench=DIR],
        [a checkout of Task Bench whose core is built (make -C DIR/core): builds bench/rivals/taskbench])], [], [with_taskbench=no])
    AS_IF([test "x$with_taskbench" != xno], [
        AS_IF([test -f "$with_taskbench/core/core_c.h" && test -f "$with_taskbench/core/libcore.a"], [],
            [AC_MSG_ERROR([--with-taskbench=$with_taskbench: there is no core/core_c.h with core/libcore.a: make -C $with_taskbench/core builds it])])
        AC_SUBST([TASKBENCH_CORE], [`cd "$with_taskbench/core" && pwd`])])
    AM_CONDITIONAL([HAVE_TASKBENCH], [test "x$with_taskbench" != xno])])

dnl DUITE_TRY_FORKS(HEADER, FLAGS, [STATEMENT]): sets duite_found to yes if CXX makes programs with it.
AC_DEFUN([DUITE_TRY_FORKS], [
    AC_MSG_CHECKING([whether ${CXX:-no compiler} makes programs with $1])
    duite_found=no
    AS_ECHO(["#include <$1>
        int main() { $3 return 0; }"]) > conftest.cpp
    AS_IF([test -n "$CXX" && $CXX -std=c++20 conftest.cpp -o conftest$EXEEXT $2 >&AS_MESSAGE_LOG_FD 2>&1], [duite_found=yes])
    rm -f conftest.cpp conftest$EXEEXT
    AC_MSG_RESULT([$duite_found])])

AC_DEFUN([DUITE_RIVALS], [
    DUITE_TASKBENCH
    duite_rivals_missing=
    AC_ARG_VAR([RIVAL_GCC], [the compiler of the rival libgomp])
    AC_ARG_VAR([RIVAL_CLANG], [the compiler of the rival libomp])
    AC_PATH_PROG([RIVAL_GCC], [gcc])
    AC_PATH_PROG([RIVAL_CLANG], [clang])
    DUITE_TRY_OPENMP([RIVAL_GCC], [-fopenmp])
    DUITE_RIVAL([LIBGOMP], [$duite_found], [gcc], [libgomp])
    DUITE_TRY_OPENMP([RIVAL_CLANG], [-fopenmp=libomp])
    DUITE_RIVAL([LIBOMP], [$duite_found], [clang with libomp-dev], [libomp])
    DUITE_TRY_FORKS([tbb/tbb.h], [-ltbb])
    DUITE_RIVAL([TBB], [$duite_found], [libtbb-dev with a C++ compiler], [oneTBB])
    AC_ARG_WITH([taskflow], [AS_HELP_STRING([--with-taskflow=DIR], [the folder that has taskflow/taskflow.hpp, version 4])],
        [TASKFLOW_CPPFLAGS="-isystem `cd "$with_taskflow" && pwd`"], [TASKFLOW_CPPFLAGS=])
    AC_SUBST([TASKFLOW_CPPFLAGS])
    DUITE_TRY_FORKS([taskflow/taskflow.hpp], [$TASKFLOW_CPPFLAGS -pthread], [tf::Executor executor; executor.task_group();])
    DUITE_RIVAL([TASKFLOW], [$duite_found], [Taskflow 4 (--with-taskflow=DIR)], [Taskflow])
    PKG_CHECK_MODULES([STARPU], [starpu-1.3], [duite_found=yes], [duite_found=no])
    STARPU_CFLAGS=`AS_ECHO(["$STARPU_CFLAGS"]) | $SED 's/-I/-isystem /g'` # its macros are not pedantic
    DUITE_RIVAL([STARPU], [$duite_found], [libstarpu-dev], [StarPU])
    AS_IF([test -n "$MPIRUN"], [duite_found=yes], [duite_found=no])
    DUITE_RIVAL([MPI], [$duite_found], [mpirun (openmpi-bin or mpich)], [MPI])
    AC_OPENMP
    AS_IF([test "x$ac_cv_prog_c_openmp" = xunsupported || test "x$ac_cv_prog_c_openmp" = xunknown],
        [duite_found=no], [duite_found=yes])
    DUITE_RIVAL([OPENMP], [$duite_found], [a compiler with OpenMP], [a plain loop])
    AC_CHECK_HEADER([embree3/rtcore.h], [AC_CHECK_LIB([embree3], [rtcCollide], [duite_found=yes], [duite_found=no])], [duite_found=no])
    DUITE_RIVAL([EMBREE], [$duite_found], [libembree-dev (version 3)], [Embree])
    DUITE_PETSC
    DUITE_RIVAL([PETSC], [$duite_found], [petsc-dev], [PETSc])
    AS_IF([test -z "$duite_rivals_missing"], [duite_rivals_say=yes],
        [duite_rivals_say="not all ($duite_rivals_missing)"])])
