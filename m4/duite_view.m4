dnl What pictures need; optional. duite_view_says names the packages that are missing and what they cost.
AC_DEFUN([DUITE_VIEW_PART], [
    PKG_CHECK_MODULES([$1], [$2], [], [duite_view_missing="$duite_view_missing${duite_view_missing:+, }$3"])])

dnl What charts as PNG need; optional. duite_chart_says names the package that is missing and what it costs.
AC_DEFUN([DUITE_CHART], [
    PKG_CHECK_MODULES([CAIRO], [cairo],
        [AC_DEFINE([HAVE_CAIRO], [1], [Define to 1 if cairo draws charts as PNG.])
         duite_chart_says="SVG, PNG"],
        [duite_chart_says="SVG   (no PNG without libcairo2-dev)"])
    AM_CONDITIONAL([HAVE_CAIRO], [test "$duite_chart_says" = "SVG, PNG"])])

AC_DEFUN([DUITE_VIEW], [
    AC_ARG_WITH([view], [AS_HELP_STRING([--without-view], [no pictures, films and windows (duite-view)])],
        [], [with_view=check])
    duite_view_missing=
    AS_IF([test "x$with_view" = xno], [duite_view_missing=--without-view], [
        DUITE_VIEW_PART([EPOXY], [epoxy], [libepoxy-dev])
        DUITE_VIEW_PART([EGL], [egl], [libegl-dev])
        DUITE_VIEW_PART([PNG], [libpng], [libpng-dev])])
    AS_IF([test "x$with_view" = xyes && test -n "$duite_view_missing"],
        [AC_MSG_ERROR([--with-view, but pkg-config does not find all it needs: install $duite_view_missing])])
    AM_CONDITIONAL([HAVE_VIEW], [test -z "$duite_view_missing"])
    VIEW_MISSING=$duite_view_missing
    AC_SUBST([VIEW_MISSING])
    AS_IF([test -z "$duite_view_missing"], [
        PKG_CHECK_MODULES([GLFW], [glfw3 >= 3.3], [duite_window=yes], [duite_window=no])
        PKG_CHECK_MODULES([CAIRO], [cairo], [], [duite_window=no])
        AS_IF([test $duite_window = yes], [
            AC_DEFINE([HAVE_WINDOW], [1], [Define to 1 if duite-view opens windows.])
            duite_view_says="pictures, films, windows"], [
            duite_view_says="pictures, films   (no windows without libglfw3-dev and libcairo2-dev)"])],
        [duite_view_says="no   ($duite_view_missing: duite-view is not built, make demo leaves the pictures out)"])
    AM_CONDITIONAL([HAVE_WINDOW], [test "$duite_window" = yes])])
