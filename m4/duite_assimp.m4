dnl Assimp, for meshes and figures of other programs; optional.
AC_DEFUN([DUITE_ASSIMP], [
    AC_ARG_WITH([assimp], [AS_HELP_STRING([--without-assimp], [no meshes and figures in glTF, FBX, Collada, PLY and STL])],
        [], [with_assimp=check])
    duite_assimp_says="no   (left out by --without-assimp: scenes read OBJ, but no glTF, FBX, Collada, PLY and STL)"
    duite_assimp=no
    AS_IF([test "x$with_assimp" != xno], [
        PKG_CHECK_MODULES([ASSIMP], [assimp >= 5], [duite_assimp=yes], [duite_assimp=no])
        AS_IF([test $duite_assimp = no && test "x$with_assimp" = xyes],
            [AC_MSG_ERROR([--with-assimp, but pkg-config finds no Assimp 5 or later: install libassimp-dev])])
        duite_assimp_says="no   (libassimp-dev: scenes read OBJ, but no glTF, FBX, Collada, PLY and STL)"])
    AS_IF([test $duite_assimp = yes], [
        duite_assimp_says=yes
        AC_DEFINE([HAVE_ASSIMP], [1], [Whether meshes of other programs are read])])
    AM_CONDITIONAL([HAVE_ASSIMP], [test $duite_assimp = yes])])
