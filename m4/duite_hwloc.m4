AC_DEFUN([DUITE_HWLOC], [
    PKG_CHECK_MODULES([HWLOC], [hwloc >= 2.0], [duite_hwloc=yes], [duite_hwloc=no])
    DUITE_NEED([$duite_hwloc], [libhwloc-dev], [topology and binding])])
