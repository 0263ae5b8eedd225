# Charts of traced runs: no part of libduite. Programs that draw link them before libduite_core.
noinst_LIBRARIES += libduite_chart.a
libduite_chart_a_SOURCES = runtime/chart/chart.h runtime/chart/draw.c runtime/chart/layout.c runtime/chart/layout.h runtime/chart/model.c \
	runtime/chart/model.h \
	runtime/chart/canvas.h runtime/chart/options.c runtime/chart/png.c runtime/chart/shares.c runtime/chart/svg.c runtime/chart/traffic.c
libduite_chart_a_CPPFLAGS = $(AM_CPPFLAGS) $(CAIRO_CFLAGS)
CHART_LIBS = libduite_chart.a libduite_predict.a $(CAIRO_LIBS) -lm
