libduite_cloth_la_SOURCES += cloth/solve/block.c cloth/solve/block.h
