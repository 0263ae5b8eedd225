/* The options of charts as command lines have them. */
#include "tools/chart/chart.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct chart_options chart_options_default(void)
{
    return (struct chart_options){.from = -INFINITY, .to = INFINITY, .width = CHART_WIDTH};
}

/* Parses a number from 0 on (to 100 if `percent`) that ends at `end`; an empty text leaves *value.
 */
static bool window_end_parse(const char *text, const char *end, bool percent, double *value)
{
    char *behind = NULL;
    if (text == end)
        return true;
    *value = strtod(text, &behind);
    if (percent && (*behind != '%' || *value > 100))
        return false;
    if (percent)
        *value /= 100;
    return behind + percent == end && *text >= '0' && *text <= '9' && isfinite(*value);
}

bool chart_window_parse(const char *text, struct chart_options *options)
{
    const char *colon = strchr(text, ':');
    struct chart_options window = *options;
    window.shares = strchr(text, '%') != NULL;
    if (!colon || !window_end_parse(text, colon, window.shares, &window.from) ||
        !window_end_parse(colon + 1, text + strlen(text), window.shares, &window.to) ||
        !(window.from < window.to))
        return false;
    *options = window;
    return true;
}

bool chart_size_parse(const char *text, struct chart_options *options)
{
    int width, height, end = 0;
    const int n = sscanf(text, "%5dx%5d%n", &width, &height, &end);
    if (n != 2 || text[end] || width < 1 || height < 1)
        return false;
    options->width = width;
    options->height = height;
    return true;
}
