dnl WARN_CFLAGS, and --enable-werror for those who change the code.
AC_DEFUN([DUITE_WARNINGS], [
    WARN_CFLAGS="-Wall -Wextra -Wpedantic -Wshadow -Wconversion"
    AC_ARG_ENABLE([werror], [AS_HELP_STRING([--enable-werror], [warnings are errors])])
    AS_IF([test "x$enable_werror" = xyes], [WARN_CFLAGS="$WARN_CFLAGS -Werror"])
    AC_SUBST([WARN_CFLAGS])])
