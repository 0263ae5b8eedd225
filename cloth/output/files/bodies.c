/* Until all are written none of an earlier run is touched. */
#include "cloth/output/files/bodies.h"
#include "cloth/output/files/files.h"
#include "cloth/output/files/obstacles.h"

#include <errno.h>
#include <stdlib.h>
#include <unistd.h>

/* The path of a body's file. NULL: out of memory. */
static char *body_path(const char *folder, uint32_t number, const char *suffix)
{
    char name[OUTPUT_BODY_NAME];
    output_body_name(name, number, "");
    return output_path(folder, name, suffix);
}

static int write_body(const char *folder, const struct contact_bodies *bodies, uint32_t number,
                      struct cloth_error *error)
{
    struct mesh mesh = {0};
    char *path = body_path(folder, number, ".part");
    int code = path ? contact_body_mesh(contact_bodies_at(bodies, number), &mesh, error)
                    : cloth_fail(error, CLOTH_E_MEMORY, "no memory for paths");
    if (!code) {
        const struct output_setup alone = {.n_meshes = 1,
                                           .meshes = (const struct mesh *const[]){&mesh},
                                           .names = (const char *const[]){"body"}};
        code = output_write_file(path, output_fill_obj, &alone, error);
    }
    mesh_free(&mesh);
    free(path);
    return code;
}

int output_bodies_write(const char *folder, const struct contact_bodies *bodies,
                        struct cloth_error *error)
{
    int code = 0;
    for (uint32_t i = 1; i <= bodies->n && !code; i++)
        code = write_body(folder, bodies, i, error);
    return code;
}

void output_bodies_drop(const char *folder, uint32_t n)
{
    for (uint32_t i = 1; i <= n; i++) {
        char *path = body_path(folder, i, ".part");
        if (path)
            unlink(path);
        free(path);
    }
}

static int rename_body(const char *folder, uint32_t number, struct cloth_error *error)
{
    char *from = body_path(folder, number, ".part"), *to = body_path(folder, number, "");
    int code = 0;
    if (!from || !to)
        code = cloth_fail(error, CLOTH_E_MEMORY, "no memory for paths");
    else if (rename(from, to) != 0)
        code = output_refuse(error, "replace", to);
    free(from);
    free(to);
    return code;
}

static int remove_body(const char *folder, uint32_t number, struct cloth_error *error)
{
    char *path = body_path(folder, number, "");
    int code = path ? 0 : cloth_fail(error, CLOTH_E_MEMORY, "no memory for paths");
    if (path && unlink(path) != 0 && errno != ENOENT)
        code = output_refuse(error, "remove", path);
    free(path);
    return code;
}

int output_bodies_replace(const char *folder, uint32_t n, uint32_t n_before,
                          struct cloth_error *error)
{
    int code = 0;
    for (uint32_t i = 1; i <= n && !code; i++)
        code = rename_body(folder, i, error);
    for (uint32_t i = n + 1; i <= n_before && !code; i++)
        code = remove_body(folder, i, error);
    return code;
}
