# A closed figure that garments are put on. Pure.
libduite_cloth_a_SOURCES += \
	cloth/mannequin/mannequin.c cloth/mannequin/mannequin.h \
	cloth/mannequin/measures.c \
	cloth/mannequin/pose.c cloth/mannequin/pose.h \
	cloth/mannequin/detail/figure.c cloth/mannequin/detail/figure.h \
	cloth/mannequin/detail/figure_parts.c \
	cloth/mannequin/detail/march.c \
	cloth/mannequin/detail/refine.c \
	cloth/mannequin/detail/surface.c cloth/mannequin/detail/surface.h
