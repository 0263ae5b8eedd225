libduite_cloth_a_SOURCES += \
	cloth/mesh/mesh.h cloth/mesh/lattice.h cloth/mesh/blocks.h cloth/mesh/slice.h \
	cloth/mesh/blocks.c cloth/mesh/coincide.c cloth/mesh/corners.c cloth/mesh/edges.c cloth/mesh/elastic.c cloth/mesh/ellipsoid.c \
	cloth/mesh/lattice.c cloth/mesh/mesh.c cloth/mesh/obj.c cloth/mesh/pc2.c cloth/mesh/shadow.c cloth/mesh/sheets.c \
	cloth/mesh/slice.c cloth/mesh/weights.c \
	cloth/mesh/detail/figure.c cloth/mesh/detail/figure.h \
	cloth/mesh/detail/finish.c cloth/mesh/detail/finish.h \
	cloth/mesh/detail/graph.c cloth/mesh/detail/graph.h \
	cloth/mesh/detail/obj.h \
	cloth/mesh/detail/obj_make.c cloth/mesh/detail/obj_names.c cloth/mesh/detail/obj_text.c cloth/mesh/detail/obj_uv.c \
	cloth/mesh/detail/order.c \
	cloth/mesh/detail/polygon.c \
	cloth/mesh/detail/sides.h
if HAVE_ASSIMP
libduite_cloth_a_SOURCES += cloth/mesh/detail/figure_clip.c cloth/mesh/detail/figure_read.c cloth/mesh/detail/figure_scene.h \
	cloth/mesh/detail/figure_skin.c
else
libduite_cloth_a_SOURCES += cloth/mesh/detail/figure_absent.c
endif
