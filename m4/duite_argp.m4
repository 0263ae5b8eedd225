dnl The command lines of all programs: glibc has it, other C libraries (musl, macOS) have it as a library of its own.
AC_DEFUN([DUITE_ARGP], [
    AC_CHECK_HEADER([argp.h], [duite_argp=yes], [duite_argp=no])
    AS_IF([test $duite_argp = yes], [AC_SEARCH_LIBS([argp_parse], [argp], [], [duite_argp=no])])
    DUITE_NEED([$duite_argp], [libc6-dev], [command lines; without glibc: argp-standalone])])
