libduite_tools_a_SOURCES += tools/chart/canvas.h tools/chart/chart.h tools/chart/draw.c tools/chart/layout.c tools/chart/layout.h \
	tools/chart/model.c tools/chart/model.h tools/chart/options.c tools/chart/png.c tools/chart/shares.c tools/chart/svg.c \
	tools/chart/traffic.c
