AC_DEFUN([DUITE_UTHASH], [
    AC_CHECK_HEADER([uthash.h], [duite_uthash=yes], [duite_uthash=no])
    DUITE_NEED([$duite_uthash], [uthash-dev], [containers])])
