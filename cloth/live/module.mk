# The live view; over ZeroMQ, which is optional. Messages are read and written in any build.
libduite_cloth_a_SOURCES += \
	cloth/live/live.h \
	cloth/live/message.h cloth/live/message.c \
	cloth/live/address.c \
	cloth/live/scene.h cloth/live/scene.c
if HAVE_ZMQ
libduite_cloth_a_SOURCES += \
	cloth/live/publisher.h cloth/live/publish.c \
	cloth/live/serve.c cloth/live/connections.c cloth/live/socket.c cloth/live/socket.h \
	cloth/live/follow.c
else
libduite_cloth_a_SOURCES += cloth/live/absent.c
endif
