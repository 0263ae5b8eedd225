dnl --enable-sanitizer=LIST, for instance address,undefined or thread: SANITIZE_FLAGS to compile and to link with. Kernels are compiled
dnl once (cloth/physics/vec.h): all forms are of one source, and with these sanitizers one of them takes a compiler a minute.
AC_DEFUN([DUITE_SANITIZE], [
    AC_ARG_ENABLE([sanitizer], [AS_HELP_STRING([--enable-sanitizer=LIST],
        [build with sanitizers: address,undefined or thread])], [], [enable_sanitizer=no])
    AS_CASE([$enable_sanitizer],
        [no], [],
        [yes], [AC_MSG_ERROR([--enable-sanitizer wants a list, for instance --enable-sanitizer=address,undefined])],
        [SANITIZE_FLAGS="-fsanitize=$enable_sanitizer -fno-sanitize-recover=all -fno-omit-frame-pointer -DPHYS_ONCE"
         duite_cflags=$CFLAGS
         CFLAGS="$CFLAGS $SANITIZE_FLAGS"
         AC_MSG_CHECKING([whether $CC $SANITIZE_FLAGS works])
         AC_LINK_IFELSE([AC_LANG_PROGRAM()], [AC_MSG_RESULT([yes])],
             [AC_MSG_RESULT([no])
              AC_MSG_ERROR([$CC has no sanitizer $enable_sanitizer; ./bootstrap --full installs what clang needs])])
         CFLAGS=$duite_cflags])
    AC_SUBST([SANITIZE_FLAGS])])
