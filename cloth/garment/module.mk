# Sewing patterns and the mesh of their panels. Pure.
libduite_cloth_a_SOURCES += \
	cloth/garment/garment.c cloth/garment/garment.h \
	cloth/garment/pattern.c cloth/garment/pattern.h \
	cloth/garment/girth.c cloth/garment/girth.h \
	cloth/garment/dxf/dxf.h \
	cloth/garment/dxf/loop.c \
	cloth/garment/dxf/pieces.c \
	cloth/garment/dxf/read.c \
	cloth/garment/dxf/text.c \
	cloth/garment/own/draw.h \
	cloth/garment/own/own.c cloth/garment/own/own.h \
	cloth/garment/own/skirt.c \
	cloth/garment/own/trousers.c \
	cloth/garment/own/tshirt.c \
	cloth/garment/detail/corners.c \
	cloth/garment/detail/curve.c cloth/garment/detail/curve.h \
	cloth/garment/detail/delaunay.c cloth/garment/detail/delaunay.h \
	cloth/garment/detail/delaunay_change.c \
	cloth/garment/detail/delaunay_fix.c \
	cloth/garment/detail/divide.c \
	cloth/garment/detail/flat.c cloth/garment/detail/flat.h \
	cloth/garment/detail/flat_improve.c \
	cloth/garment/detail/lattice.c \
	cloth/garment/detail/meet.c \
	cloth/garment/detail/pleats.c \
	cloth/garment/detail/seams.c \
	cloth/garment/detail/meshing.c cloth/garment/detail/meshing.h
