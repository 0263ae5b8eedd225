libduite_cloth_a_SOURCES += \
    cloth/solve/assemble.c cloth/solve/assemble.h \
    cloth/solve/block.c cloth/solve/block.h cloth/solve/format.h \
    cloth/solve/cg.c cloth/solve/cg.h \
    cloth/solve/coarse.c cloth/solve/coarse.h cloth/solve/couple.c cloth/solve/pattern.c \
    cloth/solve/correction.c cloth/solve/correction.h \
    cloth/solve/frame.c cloth/solve/frame.h \
    cloth/solve/levels.c cloth/solve/levels.h \
    cloth/solve/local.c cloth/solve/local.h cloth/solve/local_factor.c cloth/solve/local_rows.h cloth/solve/matrix3.h \
    cloth/solve/patches.c cloth/solve/patches.h \
    cloth/solve/system.c cloth/solve/system.h
