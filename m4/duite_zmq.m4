dnl ZeroMQ, for the live view; optional.
AC_DEFUN([DUITE_ZMQ], [
    AC_ARG_WITH([zmq], [AS_HELP_STRING([--without-zmq], [no live view (duite-cloth --live, duite-view --connect)])],
        [], [with_zmq=check])
    duite_zmq_says="no   (left out by --without-zmq: no duite-cloth --live, no duite-view --connect)"
    duite_zmq=no
    AS_IF([test "x$with_zmq" != xno], [
        PKG_CHECK_MODULES([ZMQ], [libzmq >= 4.2], [duite_zmq=yes], [duite_zmq=no])
        AS_IF([test $duite_zmq = no && test "x$with_zmq" = xyes],
            [AC_MSG_ERROR([--with-zmq, but pkg-config finds no ZeroMQ 4.2 or later: install libzmq3-dev])])
        duite_zmq_says="no   (libzmq3-dev: no duite-cloth --live, no duite-view --connect)"])
    AS_IF([test $duite_zmq = yes], [
        duite_zmq_says=yes
        AC_DEFINE([HAVE_ZMQ], [1], [Whether the live view is built])])
    AM_CONDITIONAL([HAVE_ZMQ], [test $duite_zmq = yes])])
