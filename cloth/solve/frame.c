/* A frame depends only on the first and second moments of its points, so the frame of a group
 * follows from those of its parts. */
#include "cloth/solve/frame.h"

#include "cloth/base/axes.h"
#include "cloth/base/vector.h"

#include <math.h>
#include <string.h>

void solve_axes(double m[3][3], phys_vec axis[2])
{
    double axes[3][3];
    cloth_axes(1e-300, m, axes);
    int order[3] = {0, 1, 2};
    for (int i = 0; i < 2; i++)
        for (int j = i + 1; j < 3; j++)
            if (m[order[j]][order[j]] > m[order[i]][order[i]]) {
                const int other = order[i];
                order[i] = order[j];
                order[j] = other;
            }
    const double largest = m[order[0]][order[0]];
    for (int i = 0; i < 2; i++) {
        const double *e = axes[order[i]], square = m[order[i]][order[i]];
        const double scale = square > 1e-12 * largest ? 1 / sqrt(square) : 0;
        axis[i] = (phys_vec){scale * e[0], scale * e[1], scale * e[2], 0};
    }
}

/* m += weight d d'. */
static void add_square(double weight, const double d[3], double m[3][3])
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            m[i][j] += weight * d[i] * d[j];
}

/* The extents from the moment: an axis divided by the square of its length. */
static void set_extents(double moment[3][3], struct solve_frame *frame)
{
    phys_vec axis[2];
    solve_axes(moment, axis);
    for (int i = 0; i < 2; i++) {
        const double square = phys_dot(axis + i, axis + i);
        for (int c = 0; c < 3; c++)
            frame->extent[i][c] = square > 0 ? axis[i][c] / square : 0;
    }
}

struct solve_frame solve_frame_of(size_t n, const phys_vec *position)
{
    struct solve_frame frame = {.n = (double)n};
    double moment[3][3] = {{0}};
    for (size_t a = 0; a < n; a++)
        for (int c = 0; c < 3; c++)
            frame.centre[c] += position[a][c] / frame.n;
    for (size_t a = 0; a < n; a++) {
        double d[3];
        for (int c = 0; c < 3; c++)
            d[c] = position[a][c] - frame.centre[c];
        add_square(1 / frame.n, d, moment);
    }
    set_extents(moment, &frame);
    return frame;
}

struct solve_frame solve_frame_of_group(size_t n, const struct solve_frame *part)
{
    struct solve_frame frame = {0};
    double moment[3][3] = {{0}};
    for (size_t a = 0; a < n; a++)
        frame.n += part[a].n;
    for (size_t a = 0; a < n && frame.n > 0; a++)
        for (int c = 0; c < 3; c++)
            frame.centre[c] += part[a].n / frame.n * part[a].centre[c];
    for (size_t a = 0; a < n && frame.n > 0; a++) {
        const double weight = part[a].n / frame.n;
        double d[3];
        for (int c = 0; c < 3; c++)
            d[c] = part[a].centre[c] - frame.centre[c];
        add_square(weight, d, moment);
        add_square(weight, part[a].extent[0], moment);
        add_square(weight, part[a].extent[1], moment);
    }
    set_extents(moment, &frame);
    return frame;
}

void solve_lift(const struct solve_frame *part, const struct solve_frame *group, double to[9])
{
    double d[3];
    for (int c = 0; c < 3; c++)
        d[c] = part->centre[c] - group->centre[c];
    memset(to, 0, 9 * sizeof *to);
    to[0] = 1;
    for (int k = 0; k < 2; k++) {
        const double *extent = group->extent[k], square = cloth_dot(extent, extent);
        if (!(square > 0))
            continue;
        to[1 + k] = cloth_dot(d, extent) / square;
        to[3 + 1 + k] = cloth_dot(part->extent[0], extent) / square;
        to[6 + 1 + k] = cloth_dot(part->extent[1], extent) / square;
    }
}
