libduite_cloth_a_SOURCES += \
	cloth/mesh/mesh.h cloth/mesh/lattice.h cloth/mesh/elastic.h cloth/mesh/blocks.h \
	cloth/mesh/axes.c cloth/mesh/blocks.c cloth/mesh/coincide.c cloth/mesh/disc.c cloth/mesh/edges.c cloth/mesh/elastic.c cloth/mesh/equilateral.c \
	cloth/mesh/grid.c cloth/mesh/groups.c cloth/mesh/inline.c cloth/mesh/lattice.c cloth/mesh/mesh.c cloth/mesh/obj.c cloth/mesh/pc2.c \
	cloth/mesh/places.c cloth/mesh/shadow.c cloth/mesh/slice.c cloth/mesh/slice.h \
	cloth/mesh/detail/equilateral.h \
	cloth/mesh/detail/finish.c cloth/mesh/detail/finish.h \
	cloth/mesh/detail/graph.c cloth/mesh/detail/graph.h \
	cloth/mesh/detail/islands.c cloth/mesh/detail/islands.h \
	cloth/mesh/detail/library.c cloth/mesh/detail/library.h \
	cloth/mesh/detail/lines.c cloth/mesh/detail/lines.h \
	cloth/mesh/detail/naming.c cloth/mesh/detail/naming.h \
	cloth/mesh/detail/order.c cloth/mesh/detail/partition.c \
	cloth/mesh/detail/pieces.c cloth/mesh/detail/pieces.h \
	cloth/mesh/detail/polygon.c cloth/mesh/detail/polygon.h \
	cloth/mesh/detail/sides.c cloth/mesh/detail/sides.h \
	cloth/mesh/detail/sort.c cloth/mesh/detail/sort.h \
	cloth/mesh/detail/vector.h \
	cloth/mesh/detail/words.c cloth/mesh/detail/words.h
