/* What all own garments share: their names, sizes and ranges. */
#include "cloth/garment/own/own.h"
#include "cloth/base/memory.h"
#include "cloth/garment/own/draw.h"

#include <string.h>

const struct garment_own garment_owns[] = {
    {"tshirt", "a T-shirt: front, back, and sleeves of two halves each", draw_tshirt_measures,
     draw_tshirt},
    {"trousers", "jeans: four panels of legs, and a waistband of two", draw_trousers_measures,
     draw_trousers},
    {"skirt", "a skirt: front and back, gathered to a waistband of two", draw_skirt_measures,
     draw_skirt},
    {0}};
const char garment_own_words[] = "tshirt, trousers, skirt";

enum { SIZES = 5, MIDDLE = 2 };
static const char *const SIZE[SIZES] = {"XS", "S", "M", "L", "XL"};
const char garment_size_words[] = "XS, S, M, L, XL";

const struct garment_own *garment_own_find(const char *name)
{
    for (const struct garment_own *own = garment_owns; own->name; own++)
        if (!strcmp(own->name, name))
            return own;
    return NULL;
}

int garment_size_find(const char *name)
{
    for (int i = 0; i < SIZES; i++)
        if (!strcmp(SIZE[i], name))
            return i;
    return -1;
}

void garment_own_size(const struct garment_own *own, int size, double *value)
{
    memset(value, 0, GARMENT_MEASURES * sizeof *value);
    for (int i = 0; own->measure[i].name; i++)
        value[i] = own->measure[i].fallback + (size - MIDDLE) * own->measure[i].step;
}

int garment_own_measure(const struct garment_own *own, const char *name)
{
    for (int i = 0; own->measure[i].name; i++)
        if (!strcmp(own->measure[i].name, name))
            return i;
    return -1;
}

static int check_ranges(const struct garment_own *own, const double *value,
                        struct cloth_error *error)
{
    for (int i = 0; own->measure[i].name; i++) {
        const struct garment_measure *measure = &own->measure[i];
        if (!(value[i] >= measure->least && value[i] <= measure->most))
            return cloth_fail(error, CLOTH_E_INPUT,
                              "%s: the measure %s is %g; it has to be %g to %g", own->name,
                              measure->name, value[i], measure->least, measure->most);
    }
    return CLOTH_OK;
}

int garment_own_make(struct garment_pattern *pattern, const struct garment_own *own,
                     const double *value, struct cloth_error *error)
{
    *pattern = (struct garment_pattern){0};
    int code = check_ranges(own, value, error);
    if (code)
        return code;
    pattern->panel = cloth_alloc(DRAW_PANELS, sizeof *pattern->panel, error);
    pattern->stitch = cloth_alloc(DRAW_STITCHES, sizeof *pattern->stitch, error);
    if (!pattern->panel || !pattern->stitch)
        return CLOTH_E_MEMORY;
    struct draw draw = {.pattern = pattern, .error = error};
    own->draw(&draw, value);
    return draw.code ? draw.code : garment_pattern_check(pattern, error);
}
