libduite_cloth_la_SOURCES += \
    cloth/physics/particle.c cloth/physics/particle.h \
    cloth/physics/spring.c cloth/physics/spring.h \
    cloth/physics/stage.c cloth/physics/stage.h cloth/physics/tiny.h \
    cloth/physics/vec.h
