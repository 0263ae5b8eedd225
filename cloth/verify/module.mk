# Exact tests of surfaces that go through each other; shares no code with contact. Pure.
libduite_cloth_a_SOURCES += \
	cloth/verify/enter.c \
	cloth/verify/inside.c \
	cloth/verify/meet.c cloth/verify/verify.h \
	cloth/verify/orient.c cloth/verify/orient.h \
	cloth/verify/sweep.c
