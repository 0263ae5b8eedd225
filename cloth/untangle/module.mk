# Starts that are tangled: cloths are moved apart before a run. Pure.
libduite_cloth_a_SOURCES += \
	cloth/untangle/cross.c \
	cloth/untangle/find.c \
	cloth/untangle/layers.c \
	cloth/untangle/move.c \
	cloth/untangle/near.c \
	cloth/untangle/obstacles.c \
	cloth/untangle/open.c \
	cloth/untangle/parts.c \
	cloth/untangle/shorten.c \
	cloth/untangle/state.h \
	cloth/untangle/untangle.c cloth/untangle/untangle.h \
	cloth/untangle/zones.c
