# Elements besides springs: a descriptor of each kind, and all of a model's cloths.
libduite_cloth_a_SOURCES += \
    cloth/element/air.c \
    cloth/element/bending.c \
    cloth/element/cloths.c cloth/element/cloths.h \
    cloth/element/folds.c \
    cloth/element/kind.h \
    cloth/element/kinds.c \
    cloth/element/pressure.c \
    cloth/element/size.c \
    cloth/element/strain.c cloth/element/strain.h \
    cloth/element/strain_limit.c \
    cloth/element/triangles.c
