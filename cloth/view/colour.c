/* Words, colours and numbers of scales; nothing here knows of frames or of OpenGL. */
#include "cloth/view/colour.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *const view_colour_word[VIEW_COLOURS] = {"cloth",  "block",  "rank",
                                                    "strain", "stress", "contact"};
const char *const view_colour_title[VIEW_COLOURS] = {"cloth",
                                                     "block",
                                                     "rank",
                                                     "largest principal strain, m/m",
                                                     "largest principal stress, N/m",
                                                     "force of contact on a vertex, N"};

/* ,MAX or ,MIN:MAX */
static bool parse_scale(const char *text, struct view_scale *scale)
{
    char *end = NULL;
    *scale = (struct view_scale){0, 0};
    if (*text++ != ',')
        return false;
    double first = strtod(text, &end);
    if (end == text)
        return false;
    scale->max = first;
    if (*end == ':') {
        text = end + 1;
        scale->min = first;
        scale->max = strtod(text, &end);
        if (end == text)
            return false;
    }
    return !*end;
}

const char *view_colouring_parse(const char *text, struct view_colouring *colouring)
{
    const size_t n = strcspn(text, ",");
    enum view_colour by = VIEW_COLOUR_CLOTH;
    while (by < VIEW_COLOURS &&
           !(strlen(view_colour_word[by]) == n && memcmp(view_colour_word[by], text, n) == 0))
        by++;
    if (by == VIEW_COLOURS)
        return "takes block, rank, strain, stress, contact or cloth";
    *colouring = (struct view_colouring){.by = by, .has_scale = text[n] != '\0'};
    if (!colouring->has_scale)
        return NULL;
    if (!view_colour_has_scale(by))
        return "takes a scale with strain (m/m), stress (N/m) and contact (N) only";
    if (!parse_scale(text + n, &colouring->scale))
        return "takes a scale as WORD,MAX or WORD,MIN:MAX, such as strain,0.05 or stress,-10:100";
    if (!isfinite(colouring->scale.min) || !isfinite(colouring->scale.max) ||
        !(colouring->scale.min < colouring->scale.max))
        return "takes a scale whose MAX is above its MIN (0, unless told)";
    return NULL;
}

/* ---- Numbers ---- */

#define RGB(r, g, b)                                                                               \
    {                                                                                              \
        (r) / 255.0f, (g) / 255.0f, (b) / 255.0f                                                   \
    }
const float view_map[VIEW_MAP][3] = {
    RGB(0x44, 0x01, 0x54), RGB(0x48, 0x28, 0x78), RGB(0x3e, 0x4a, 0x89), RGB(0x31, 0x68, 0x8e),
    RGB(0x26, 0x82, 0x8e), RGB(0x1f, 0x9e, 0x89), RGB(0x35, 0xb7, 0x79), RGB(0x6d, 0xcd, 0x59),
    RGB(0xb4, 0xde, 0x2c), RGB(0xfd, 0xe7, 0x25)};

void view_map_at(double part, float colour[3])
{
    const double at = fmin(fmax(part, 0), 1) * (VIEW_MAP - 1);
    const int i = at < VIEW_MAP - 1 ? (int)at : VIEW_MAP - 2;
    const float behind = (float)(at - i);
    for (int k = 0; k < 3; k++)
        colour[k] = view_map[i][k] + behind * (view_map[i + 1][k] - view_map[i][k]);
}

double view_scale_part(const struct view_scale *scale, double value)
{
    return fmin(fmax((value - scale->min) / (scale->max - scale->min), 0), 1);
}

/* The next number of 1, 2, 5 with zeros that is not below a positive one, but for rounding of
 * floats. */
static double round_up(double value)
{
    const double near = 1e-4, unit = pow(10, floor(log10(value * (1 - near))));
    const double steps[] = {1, 2, 5, 10};
    int i = 0;
    while (i < 3 && steps[i] * unit < value * (1 - near))
        i++;
    return steps[i] * unit;
}

struct view_scale view_scale_up_to(double max)
{
    return (struct view_scale){0, max > 0 && isfinite(max) ? round_up(max) : 1};
}

/* Numbers of one scale have as many digits behind the point. */
static void write_tick(char text[VIEW_TICK_TEXT], double value, double step)
{
    const double largest = fmax(fabs(value), step);
    const int digits = (int)fmax(0, -floor(log10(step) + 1e-9));
    if (largest < 1e6 && digits <= 4)
        snprintf(text, VIEW_TICK_TEXT, "%.*f", digits, value);
    else
        snprintf(text, VIEW_TICK_TEXT, "%.3g", value);
}

void view_scale_ticks(const struct view_scale *scale, struct view_ticks *ticks)
{
    const double range = scale->max - scale->min;
    double step = round_up(range / (VIEW_TICKS - 1));
    ticks->n = 0;
    for (double i = ceil(scale->min / step - 1e-6);
         i * step <= scale->max + 1e-6 * step && ticks->n < VIEW_TICKS; i++) {
        const double value = i == 0 ? 0 : i * step;
        ticks->value[ticks->n] = value;
        write_tick(ticks->text[ticks->n++], value, step);
    }
}

/* ---- Parts ---- */

const float view_hue[VIEW_HUES][3] = {
    RGB(0xe6, 0x9f, 0x00), RGB(0x56, 0xb4, 0xe9), RGB(0x00, 0x9e, 0x73), RGB(0xf0, 0xe4, 0x42),
    RGB(0x00, 0x72, 0xb2), RGB(0xd5, 0x5e, 0x00), RGB(0xcc, 0x79, 0xa7), RGB(0xbb, 0xbb, 0xbb)};

/* The colours of the earlier neighbours of each part, as bits. */
static void colour_find_near(uint32_t n_triangles, const uint32_t *triangle, const int32_t *part,
                             uint32_t n_parts, const unsigned char *hue, unsigned *near)
{
    memset(near, 0, n_parts * sizeof *near);
    for (size_t i = 0; i < (size_t)3 * n_triangles; i++) {
        const int32_t one = part[triangle[i]], other = part[triangle[i % 3 == 2 ? i - 2 : i + 1]];
        if (one >= 0 && other >= 0 && one != other)
            near[one > other ? one : other] |= 1u << hue[one > other ? other : one];
    }
}

static unsigned char first_free(uint32_t part, unsigned near)
{
    for (uint32_t i = 0; i < VIEW_HUES; i++)
        if (!(near >> (part + i) % VIEW_HUES & 1))
            return (unsigned char)((part + i) % VIEW_HUES);
    return (unsigned char)(part % VIEW_HUES);
}

/* A part depends on those before it alone, so that rounds end; most end after a few. */
void view_hues_spread(uint32_t n_triangles, const uint32_t *triangle, const int32_t *part,
                      uint32_t n_parts, unsigned char *hue, unsigned *near)
{
    bool changed = n_parts > VIEW_HUES;
    for (uint32_t p = 0; p < n_parts; p++)
        hue[p] = (unsigned char)(p % VIEW_HUES);
    while (changed) {
        changed = false;
        colour_find_near(n_triangles, triangle, part, n_parts, hue, near);
        for (uint32_t p = 0; p < n_parts; p++) {
            const unsigned char next = first_free(p, near[p]);
            changed = changed || next != hue[p];
            hue[p] = next;
        }
    }
}
