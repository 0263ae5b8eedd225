libduite_cloth_la_SOURCES += cloth/base/error.c cloth/base/error.h
