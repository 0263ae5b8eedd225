# Shapes that cloth meets, one file a kind. Pure.
libduite_cloth_a_SOURCES += \
	cloth/contact/apart.h \
	cloth/contact/body.c cloth/contact/body.h \
	cloth/contact/body_check.c cloth/contact/making.h \
	cloth/contact/body_fan.c \
    cloth/contact/body_frames.c \
	cloth/contact/body_make.c \
	cloth/contact/body_skin.c cloth/contact/body_skin.h \
	cloth/contact/body_tree.c \
	cloth/contact/box.c \
	cloth/contact/capsule.c \
	cloth/contact/certificate.c cloth/contact/certificate_four.c cloth/contact/certificate.h cloth/contact/direction.h cloth/contact/volume.h \
	cloth/contact/cylinder.c \
	cloth/contact/image.c cloth/contact/image.h cloth/contact/image_draw.c \
	cloth/contact/meet.c cloth/contact/meet.h \
	cloth/contact/pair.c cloth/contact/pair.h \
	cloth/contact/plane.c \
	cloth/contact/push.h \
	cloth/contact/repulse.h \
	cloth/contact/row.h \
	cloth/contact/soup.c cloth/contact/soup.h \
	cloth/contact/shape.c cloth/contact/shape.h \
	cloth/contact/skin.h cloth/contact/skin_table.h \
	cloth/contact/skin_flat.c \
	cloth/contact/skin_loops.c \
	cloth/contact/skin_make.c \
	cloth/contact/skin_moved.c \
	cloth/contact/skin_query.c \
	cloth/contact/skin_refit.c cloth/contact/skin_ridge.c \
	cloth/contact/skin_bunch.c cloth/contact/skin_leaves.c cloth/contact/skin_lanes.h \
	cloth/contact/solid.c cloth/contact/solid.h cloth/contact/solid_core.h \
	cloth/contact/solid_cut.c cloth/contact/solid_divide.h \
	cloth/contact/solid_nearest.c \
	cloth/contact/sphere.c \
	cloth/contact/surface.c cloth/contact/surface.h \
	cloth/contact/view.c cloth/contact/view.h
