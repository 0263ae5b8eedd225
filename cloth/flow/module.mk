libduite_cloth_la_SOURCES += \
    cloth/flow/model.c cloth/flow/model.h \
    cloth/flow/long_steps.c cloth/flow/long_steps.h \
    cloth/flow/run.c cloth/flow/run.h cloth/flow/warn.c \
    cloth/flow/tables/limit.c \
    cloth/flow/tables/loads.c \
    cloth/flow/tables/elements.c cloth/flow/tables/elements.h \
    cloth/flow/tables/members.c \
    cloth/flow/tables/neighbours.c \
    cloth/flow/tables/picks.c \
    cloth/flow/tables/pieces.c \
    cloth/flow/tables/particles.c \
    cloth/flow/tables/starts.c \
    cloth/flow/tables/sides.c \
    cloth/flow/tables/source.c cloth/flow/tables/source.h \
    cloth/flow/tables/springs.c \
    cloth/flow/tables/watched.c \
    cloth/flow/tables/tables.c cloth/flow/tables/tables.h \
    cloth/flow/tasks/bodies.h \
    cloth/flow/tasks/guides.h \
    cloth/flow/tasks/cg.c \
    cloth/flow/tasks/deal.c \
    cloth/flow/tasks/energy.c \
    cloth/flow/tasks/elements.c \
    cloth/flow/tasks/explicit.c \
    cloth/flow/tasks/far.c \
    cloth/flow/tasks/finish.c \
    cloth/flow/tasks/frames.c \
    cloth/flow/tasks/grid.c cloth/flow/tasks/energy.h cloth/flow/tasks/grid.h \
    cloth/flow/tasks/implicit.c \
    cloth/flow/tasks/kernels_cg.c \
    cloth/flow/tasks/kernels_beside.c \
    cloth/flow/tasks/kernels_coarse.c \
    cloth/flow/tasks/kernels_contact.c \
    cloth/flow/tasks/kernels_energy.c \
    cloth/flow/tasks/kernels_explicit.c \
    cloth/flow/tasks/kernels_implicit.c \
    cloth/flow/tasks/kernels_pieces.c cloth/flow/tasks/kernels_pins.c \
    cloth/flow/tasks/kernels_report.c \
    cloth/flow/tasks/kernels_state.c \
    cloth/flow/tasks/kernels_step.c cloth/flow/tasks/kernels_system.c \
    cloth/flow/tasks/kernels_turned.c \
    cloth/flow/tasks/kernels_watch.c \
    cloth/flow/tasks/memory.c \
    cloth/flow/tasks/objects.c \
    cloth/flow/tasks/step.c \
    cloth/flow/tasks/system.c \
    cloth/flow/tasks/kernels.h cloth/flow/tasks/patches.h cloth/flow/tasks/tasks.h \
    cloth/flow/tasks/turned.c \
    cloth/flow/tasks/varying.c \
    cloth/flow/tasks/watch.c
