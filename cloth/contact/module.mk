# Shapes that cloth meets, one file a kind. Pure.
libduite_cloth_la_SOURCES += \
	cloth/contact/meet.c cloth/contact/meet.h \
	cloth/contact/plane.c \
	cloth/contact/shape.c cloth/contact/shape.h
