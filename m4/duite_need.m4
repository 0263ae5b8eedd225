dnl DUITE_NEED(FOUND, PACKAGE, PURPOSE): unless FOUND is yes, remembers a package without which nothing can be built.
AC_DEFUN([DUITE_NEED], [
    AS_IF([test "x$1" != xyes], [duite_missing="$duite_missing
    $2	$3"])])

dnl DUITE_NEED_ALL: one message for everything that is missing.
AC_DEFUN([DUITE_NEED_ALL], [
    AS_IF([test -n "$duite_missing"], [AC_MSG_ERROR([these packages are missing (Debian names):
$duite_missing

./bootstrap installs them.])])])
