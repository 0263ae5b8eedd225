/* A point p at (x, y, z) in the camera's axes is within the margins of an eye at e if |x - ex| <= t
 * (ez - z), and so in y. Each is two linear conditions on (ex, ez), so the largest of four sums
 * over the points decides where the nearest eye is: points may come in any number and order. */
#include "cloth/view/view.h"

#include <cglm/cam.h>
#include <cglm/mat4.h>
#include <math.h>
#include <stdbool.h>

static const double HALF_ANGLE = 15.0; /* degrees, of the height */
static const double MARGIN = 0.86;     /* of half the picture that the points may fill */

static double radians(double degrees)
{
    return degrees * (acos(-1.0) / 180.0);
}

void view_fit_start(struct view_fit *fit, double azimuth, double elevation, double aspect,
                    double zoom)
{
    double a = radians(azimuth), e = radians(elevation);
    *fit = (struct view_fit){
        .side = {{cos(a), 0, -sin(a)},
                 {-sin(e) * sin(a), cos(e), -sin(e) * cos(a)},
                 {cos(e) * sin(a), sin(e), cos(e) * cos(a)}},
        .aspect = aspect,
        .zoom = zoom,
        .near = -INFINITY,
        .far = INFINITY,
    };
    fit->tangent[1] = tan(radians(HALF_ANGLE)) * MARGIN;
    fit->tangent[0] = fit->tangent[1] * aspect;
    for (int i = 0; i < 4; i++)
        fit->max[i] = -INFINITY;
    for (int i = 0; i < 3; i++) {
        fit->low[i] = INFINITY;
        fit->high[i] = -INFINITY;
    }
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void show(struct view_fit *fit, const double p[3])
{
    double z = dot(fit->side[2], p);
    for (int i = 0; i < 2; i++) {
        double x = dot(fit->side[i], p), t = fit->tangent[i];
        fit->max[2 * i] = fmax(fit->max[2 * i], x + t * z);
        fit->max[2 * i + 1] = fmax(fit->max[2 * i + 1], t * z - x);
    }
    fit->near = fmax(fit->near, z);
    fit->far = fmin(fit->far, z);
}

void view_fit_add(struct view_fit *fit, size_t n, const double *position)
{
    for (size_t v = 0; v < n; v++) {
        const double *p = position + 3 * v;
        show(fit, p);
        for (int i = 0; i < 3; i++) {
            fit->low[i] = fmin(fit->low[i], p[i]);
            fit->high[i] = fmax(fit->high[i], p[i]);
        }
    }
}

static double extent(const struct view_fit *fit)
{
    double max = 0;
    for (int i = 0; i < 3; i++)
        max = fmax(max, fit->high[i] - fit->low[i]);
    return max;
}

/* A plane farther away than the points are wide would only push the camera back. */
void view_fit_planes(struct view_fit *fit, size_t n, const double (*planes)[6])
{
    for (size_t i = 0; i < n; i++) {
        const double *point = planes[i], *normal = planes[i] + 3;
        for (int corner = 0; corner < 8; corner++) {
            double p[3];
            for (int k = 0; k < 3; k++)
                p[k] = corner >> k & 1 ? fit->high[k] : fit->low[k];
            double height = (dot(p, normal) - dot(point, normal)) / dot(normal, normal);
            if (!(fabs(height) * sqrt(dot(normal, normal)) <= extent(fit)))
                continue;
            for (int k = 0; k < 3; k++)
                p[k] -= height * normal[k];
            show(fit, p);
        }
    }
}

void view_fit_near(struct view_fit *fit, size_t n, const double (*vertex)[6])
{
    const double margin = 0.5 * extent(fit);
    for (size_t i = 0; i < n; i++) {
        bool near = true;
        for (int k = 0; k < 3; k++)
            near = near && vertex[i][k] >= fit->low[k] - margin &&
                   vertex[i][k] <= fit->high[k] + margin;
        if (near)
            show(fit, vertex[i]);
    }
}

static void place_eye(const struct view_fit *fit, double size, double eye[3])
{
    eye[2] = fit->near + 0.1 * size; /* of a single point, or a chain along the line of sight */
    for (int i = 0; i < 2; i++) {
        eye[i] = 0.5 * (fit->max[2 * i] - fit->max[2 * i + 1]);
        double distance = (fit->max[2 * i] + fit->max[2 * i + 1]) / (2 * fit->tangent[i]);
        eye[2] = fmax(eye[2], distance);
    }
}

void view_fit_camera(const struct view_fit *fit, struct view_camera *camera)
{
    double size = fmax(extent(fit), 1e-3), eye[3];
    place_eye(fit, size, eye);
    mat4 view = GLM_MAT4_IDENTITY_INIT, projection;
    for (int k = 0; k < 3; k++) {
        double place = 0;
        for (int i = 0; i < 3; i++) {
            place += eye[i] * fit->side[i][k];
            view[k][i] = (float)fit->side[i][k];
        }
        camera->eye[k] = (float)place;
        view[3][k] = (float)-eye[k];
    }
    double angle = 2 * atan(tan(radians(HALF_ANGLE)) / fit->zoom);
    double near = 0.3 * (eye[2] - fit->near), far = eye[2] - fit->far + 40 * size;
    glm_perspective((float)angle, (float)fit->aspect, (float)near, (float)far, projection);
    glm_mat4_mul(projection, view, camera->clip);
    camera->reach = (float)size;
}
