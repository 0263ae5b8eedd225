AC_DEFUN([DUITE_YAML], [
    PKG_CHECK_MODULES([YAML], [yaml-0.1], [duite_yaml=yes], [duite_yaml=no])
    DUITE_NEED([$duite_yaml], [libyaml-dev], [scene files])])
