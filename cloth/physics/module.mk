libduite_cloth_a_SOURCES += \
    cloth/physics/air.c cloth/physics/air.h \
    cloth/physics/bending.h \
    cloth/physics/curve.c cloth/physics/curve.h \
    cloth/physics/element.h \
    cloth/physics/quadratic.c \
    cloth/physics/hinge.c \
    cloth/physics/limit.c cloth/physics/limit.h \
    cloth/physics/motion.c cloth/physics/motion.h \
    cloth/physics/particle.c cloth/physics/particle.h \
    cloth/physics/spring.c cloth/physics/spring.h \
    cloth/physics/tiny.h \
    cloth/physics/strain_limit.c cloth/physics/strain_limit.h \
    cloth/physics/triangle.c cloth/physics/triangle_system.c cloth/physics/triangle.h \
    cloth/physics/vec.h \
    cloth/physics/detail/hinge.h \
    cloth/physics/detail/lanes.h \
    cloth/physics/detail/membrane.h
