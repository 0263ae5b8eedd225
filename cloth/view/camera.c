/* A point p at (x, y, z) in the camera's axes is within the margins of an eye at e if |x - ex| <= t
 * (ez - z), and so in y. Each is two linear conditions on (ex, ez), so the nearest eye follows from
 * the largest of four sums over the points, in any number and order. */
#include "cloth/view/view.h"

#include "cloth/base/vector.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

static const double HALF_ANGLE = 15.0; /* degrees, of the height */
static const double MARGIN = 0.86;     /* of half the picture that the points may fill */

static double radians(double degrees)
{
    return degrees * (acos(-1.0) / 180.0);
}

/* Rows: right, up and back of a camera. */
static void sides(double azimuth, double elevation, double side[3][3])
{
    const double a = radians(azimuth), e = radians(elevation);
    const double rows[3][3] = {{cos(a), 0, -sin(a)},
                               {-sin(e) * sin(a), cos(e), -sin(e) * cos(a)},
                               {cos(e) * sin(a), sin(e), cos(e) * cos(a)}};
    memcpy(side, rows, sizeof rows);
}

void view_fit_start(struct view_fit *fit, double azimuth, double elevation, double aspect,
                    double zoom)
{
    *fit = (struct view_fit){
        .azimuth = azimuth,
        .elevation = elevation,
        .aspect = aspect,
        .zoom = zoom,
        .near = -INFINITY,
        .far = INFINITY,
    };
    sides(azimuth, elevation, fit->side);
    fit->tangent[1] = tan(radians(HALF_ANGLE)) * MARGIN;
    fit->tangent[0] = fit->tangent[1] * aspect;
    for (int i = 0; i < 4; i++)
        fit->max[i] = -INFINITY;
    for (int i = 0; i < 3; i++) {
        fit->low[i] = INFINITY;
        fit->high[i] = -INFINITY;
    }
}

static void camera_show(struct view_fit *fit, const double p[3])
{
    double z = cloth_dot(fit->side[2], p);
    for (int i = 0; i < 2; i++) {
        double x = cloth_dot(fit->side[i], p), t = fit->tangent[i];
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
        camera_show(fit, p);
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
            double height =
                (cloth_dot(p, normal) - cloth_dot(point, normal)) / cloth_dot(normal, normal);
            if (!(fabs(height) * sqrt(cloth_dot(normal, normal)) <= extent(fit)))
                continue;
            for (int k = 0; k < 3; k++)
                p[k] -= height * normal[k];
            camera_show(fit, p);
        }
    }
}

static bool camera_is_near(const struct view_fit *fit, const double p[3])
{
    const double margin = 0.5 * extent(fit);
    bool near = true;
    for (int k = 0; k < 3; k++)
        near = near && p[k] >= fit->low[k] - margin && p[k] <= fit->high[k] + margin;
    return near;
}

/* Something is near, and all of it is not so large that the cloth is lost in it. */
static bool is_worn(const struct view_fit *fit, size_t n, const double (*vertex)[6])
{
    const double LARGEST = 4; /* of the points' extent */
    bool near = false;
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (size_t i = 0; i < n; i++) {
        near = near || camera_is_near(fit, vertex[i]);
        for (int k = 0; k < 3; k++) {
            low[k] = fmin(low[k], vertex[i][k]);
            high[k] = fmax(high[k], vertex[i][k]);
        }
    }
    for (int k = 0; k < 3; k++)
        near = near && high[k] - low[k] <= LARGEST * extent(fit);
    return near;
}

void view_fit_near(struct view_fit *fit, size_t n, const double (*vertex)[6], bool body)
{
    const bool whole = body && is_worn(fit, n, vertex);
    for (size_t i = 0; i < n; i++)
        if (whole || camera_is_near(fit, vertex[i]))
            camera_show(fit, vertex[i]);
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

void view_fit_orbit(const struct view_fit *fit, struct view_orbit *orbit)
{
    const double size = fmax(extent(fit), 1e-3);
    double eye[3], middle = 0, half = 0;
    place_eye(fit, size, eye);
    for (int k = 0; k < 3; k++) {
        middle += fit->side[2][k] * 0.5 * (fit->low[k] + fit->high[k]);
        half += (fit->high[k] - fit->low[k]) * (fit->high[k] - fit->low[k]) / 4;
    }
    *orbit = (struct view_orbit){.azimuth = fit->azimuth,
                                 .elevation = fit->elevation,
                                 .zoom = fit->zoom,
                                 .distance = eye[2] - middle,
                                 .front = fit->near - middle,
                                 .behind = middle - fit->far,
                                 .radius = sqrt(half),
                                 .size = size};
    eye[2] = middle;
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < 3; i++)
            orbit->target[k] += eye[i] * fit->side[i][k];
}

/* A point is at v in the axes of a camera, with its eye at 0. Clip coordinates are (wide v0, high
 * v1, slope v2 + shift, -v2), so that depth is -1 at near and 1 at far. */
void view_orbit_camera(const struct view_orbit *orbit, double aspect, struct view_camera *camera)
{
    const double high = orbit->zoom / tan(radians(HALF_ANGLE)), wide = high / aspect;
    const double near = fmax(0.3 * (orbit->distance - orbit->front), 0.01 * orbit->distance);
    const double far = orbit->distance + orbit->behind + 40 * orbit->size;
    const double slope = (far + near) / (near - far), shift = 2 * far * near / (near - far);
    double side[3][3], eye[3], v[3];
    sides(orbit->azimuth, orbit->elevation, side);
    for (int k = 0; k < 3; k++)
        eye[k] = orbit->target[k] + orbit->distance * side[2][k];
    for (int i = 0; i < 3; i++)
        v[i] = -cloth_dot(side[i], eye);
    const double origin[4] = {wide * v[0], high * v[1], slope * v[2] + shift, -v[2]};
    const double back[4] = {0, 0, 1 / shift, slope / shift};
    for (int k = 0; k < 3; k++) {
        const double clip[4] = {wide * side[0][k], high * side[1][k], slope * side[2][k],
                                -side[2][k]};
        const double world[4] = {side[0][k] / wide, side[1][k] / high, back[2] * eye[k],
                                 back[3] * eye[k] - side[2][k]};
        camera->eye[k] = (float)eye[k];
        for (int i = 0; i < 4; i++) {
            camera->clip[k][i] = (float)clip[i];
            camera->world[i][k] = (float)world[i];
        }
    }
    for (int i = 0; i < 4; i++) {
        camera->clip[3][i] = (float)origin[i];
        camera->world[i][3] = (float)back[i];
    }
    camera->reach = (float)orbit->size;
}

/* How near and far things are is known of the direction that was fitted. Another direction uses a
 * sphere around them. */
static void lose_depths(struct view_orbit *orbit)
{
    orbit->front = fmax(orbit->front, orbit->radius);
    orbit->behind = fmax(orbit->behind, orbit->radius);
}

void view_orbit_turn(struct view_orbit *orbit, double azimuth, double elevation)
{
    orbit->azimuth = remainder(orbit->azimuth + azimuth, 360);
    orbit->elevation = fmin(fmax(orbit->elevation + elevation, -89), 89);
    lose_depths(orbit);
}

void view_orbit_pan(struct view_orbit *orbit, double right, double up)
{
    const double height = 2 * orbit->distance * tan(radians(HALF_ANGLE)) / orbit->zoom;
    double side[3][3];
    sides(orbit->azimuth, orbit->elevation, side);
    for (int k = 0; k < 3; k++)
        orbit->target[k] -= height * (right * side[0][k] + up * side[1][k]);
}

void view_orbit_zoom(struct view_orbit *orbit, double factor)
{
    orbit->zoom = fmin(fmax(orbit->zoom * factor, 0.2), 1000);
}

void view_fit_camera(const struct view_fit *fit, struct view_camera *camera)
{
    struct view_orbit orbit;
    view_fit_orbit(fit, &orbit);
    view_orbit_camera(&orbit, fit->aspect, camera);
}
