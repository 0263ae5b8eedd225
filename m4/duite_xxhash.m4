AC_DEFUN([DUITE_XXHASH], [
    PKG_CHECK_MODULES([XXHASH], [libxxhash], [duite_xxhash=yes], [duite_xxhash=no])
    DUITE_NEED([$duite_xxhash], [libxxhash-dev], [hashes])])
