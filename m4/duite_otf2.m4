dnl OTF2 3, for duite-trace --otf2; optional. It has no pkg-config file, and another name in Debian: a call in the form of version 3 is tried.
AC_DEFUN([DUITE_OTF2], [
    AC_MSG_CHECKING([for OTF2 3])
    OTF2_LIBS=
    duite_saved_LIBS=$LIBS
    for duite_try in -lotf2 -lopen-trace-format2; do
        LIBS="$duite_try $duite_saved_LIBS"
        test -n "$OTF2_LIBS" ||
            AC_LINK_IFELSE([AC_LANG_PROGRAM([#include <otf2/otf2.h>], [
                return OTF2_GlobalDefWriter_WriteLocationGroup(0, 0, 0, OTF2_LOCATION_GROUP_TYPE_PROCESS, 0, OTF2_UNDEFINED_LOCATION_GROUP);])],
                [OTF2_LIBS=$duite_try])
    done
    LIBS=$duite_saved_LIBS
    AC_SUBST([OTF2_LIBS])
    AC_MSG_RESULT([${OTF2_LIBS:-no}])
    duite_otf2_says="no   (libopen-trace-format2-dev: no duite-trace --otf2)"
    AS_IF([test -n "$OTF2_LIBS"], [
        duite_otf2_says=yes
        AC_DEFINE([HAVE_OTF2], [1], [Define to 1 if duite-trace writes OTF2.])])])
