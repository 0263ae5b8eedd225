libduite_cloth_la_SOURCES += \
    cloth/solve/block.c cloth/solve/block.h \
    cloth/solve/cg.c cloth/solve/cg.h \
    cloth/solve/system.c cloth/solve/system.h
