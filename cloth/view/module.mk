# Pictures are optional: configure says what they need.
if HAVE_VIEW
noinst_LIBRARIES += libduite_view.a
libduite_view_a_SOURCES = \
	cloth/view/view.h \
	cloth/view/camera.c \
	cloth/view/context.c \
	cloth/view/colour.h cloth/view/colour.c \
	cloth/view/colours.h cloth/view/colours.c \
	cloth/view/export.h cloth/view/export.c cloth/view/gltf.c cloth/view/usd.c \
	cloth/view/abc.h cloth/view/abc.c cloth/view/abc_groups.c cloth/view/ogawa.h cloth/view/ogawa.c \
	cloth/view/film.h cloth/view/film.c \
	cloth/view/legend.h cloth/view/legend.c \
	cloth/view/obstacles.c \
	cloth/view/pick.h cloth/view/pick.c \
	cloth/view/picture.c \
	cloth/view/player.h cloth/view/player.c \
	cloth/view/scene.h cloth/view/scene.c cloth/view/scene_draw.c \
	cloth/view/show.h cloth/view/show.c \
	cloth/view/values.c \
	cloth/view/draw/draw.h \
	cloth/view/draw/ground.c \
	cloth/view/draw/lights.c \
	cloth/view/draw/mesh.c \
	cloth/view/draw/program.c \
	cloth/view/draw/shaders.c \
	cloth/view/draw/sky.c \
	cloth/view/draw/surfaces.c
if HAVE_WINDOW
libduite_view_a_SOURCES += cloth/view/overlay.h cloth/view/overlay.c cloth/view/window.h cloth/view/window.c
endif
libduite_view_a_CPPFLAGS = $(AM_CPPFLAGS) $(EPOXY_CFLAGS) $(EGL_CFLAGS) $(PNG_CFLAGS) $(GLFW_CFLAGS) $(CAIRO_CFLAGS)
# epoxy opens libEGL and libGL itself, so that their absence can be told.
VIEW_LIBS = libduite_view.a $(EPOXY_LIBS) $(PNG_LIBS) $(GLFW_LIBS) $(CAIRO_LIBS) -ldl $(CLOTH_LIBS)
endif
