/* Two comparisons. The models of all phases share cloths and obstacles, as one folder holds all
 * frames. A run has the settings and files of the checkpoint that it resumes, as only then both
 * have the same states. */
#include "cloth/app/run/phases.h"

#include "cloth/base/file.h"
#include "cloth/base/memory.h"
#include "cloth/contact/body.h"

#include <config.h>

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <xxhash.h>

/* ---- Phases ---- */

struct comparison {
    const struct model *first, *model;
    const struct model_phase *phase;
    struct cloth_error *error;
};

static int phase_differs(const struct comparison *of, const char *what)
{
    return model_fail(of->phase->place, of->error,
                      "phase '%.60s' has %s than the first phase; frames, probes and their names "
                      "are the same in all phases",
                      of->phase->name, what);
}

static int check_cloths(const struct comparison *of)
{
    if (of->first->n_cloths != of->model->n_cloths)
        return phase_differs(of, "another number of cloths");
    for (uint32_t c = 0; c < of->first->n_cloths; c++) {
        const struct model_cloth *a = of->first->cloths + c, *b = of->model->cloths + c;
        char what[160];
        const bool renamed = strcmp(a->name, b->name) != 0;
        if (!renamed && a->mesh.n_vertices == b->mesh.n_vertices &&
            a->mesh.n_triangles == b->mesh.n_triangles)
            continue;
        snprintf(what, sizeof what,
                 renamed ? "another name of cloth '%.60s'"
                         : "other vertices or triangles of cloth '%.60s'",
                 a->name);
        return phase_differs(of, what);
    }
    return CLOTH_OK;
}

static bool same_pick(const struct model_pick *a, const struct model_pick *b)
{
    return a->kind == b->kind && a->n_vertices == b->n_vertices &&
           !memcmp(a->point, b->point, sizeof a->point) && !(a->radius < b->radius) &&
           !(a->radius > b->radius) && !memcmp(a->box, b->box, sizeof a->box) &&
           (!a->n_vertices ||
            !memcmp(a->vertices, b->vertices, a->n_vertices * sizeof *a->vertices));
}

static bool same_probe(const struct model_probe *a, const struct model_probe *b)
{
    return !strcmp(a->name, b->name) && a->cloth == b->cloth && a->position == b->position &&
           a->velocity == b->velocity && a->reaction == b->reaction && a->contact == b->contact &&
           a->total == b->total && a->contact_total == b->contact_total &&
           a->by_obstacle == b->by_obstacle && a->obstacle == b->obstacle &&
           same_pick(&a->pick, &b->pick);
}

static int check_probes(const struct comparison *of)
{
    bool same = of->first->n_probes == of->model->n_probes;
    for (uint32_t i = 0; same && i < of->first->n_probes; i++)
        same = same_probe(of->first->probes + i, of->model->probes + i);
    return same ? CLOTH_OK : phase_differs(of, "other probes");
}

static bool same_body(const struct contact_body *a, const struct contact_body *b)
{
    return a == b || (a && b && a->n_vertices == b->n_vertices && a->n_triangles == b->n_triangles);
}

/* Their motions may be others, but about the same point. */
static bool same_obstacle(const struct comparison *of, uint32_t i)
{
    const struct contact_shape *a = of->first->obstacles + i, *b = of->model->obstacles + i;
    return a->kind == b->kind && a->body == b->body &&
           same_body(contact_bodies_at(&of->first->bodies, a->body),
                     contact_bodies_at(&of->model->bodies, b->body)) &&
           !memcmp(a->value, b->value, sizeof a->value) &&
           (!a->n || !b->n || !memcmp(a->about, b->about, sizeof a->about));
}

static int check_obstacles(const struct comparison *of)
{
    bool same = of->first->n_obstacles == of->model->n_obstacles;
    for (uint32_t i = 0; same && i < of->first->n_obstacles; i++)
        same = same_obstacle(of, i);
    return same ? CLOTH_OK : phase_differs(of, "other obstacles, or motions about other points,");
}

static bool same_hdf5(const struct model_hdf5 *a, const struct model_hdf5 *b)
{
    return a->velocity == b->velocity && a->block == b->block && a->rank == b->rank &&
           a->contact_force == b->contact_force && a->strain == b->strain &&
           a->stress == b->stress && a->is_double == b->is_double && a->every == b->every &&
           a->level == b->level;
}

int phases_check(const struct model *first, const struct model *model, uint32_t phase,
                 struct cloth_error *error)
{
    const struct comparison of = {first, model, model->phases + phase, error};
    if (strcmp(first->name, model->name) != 0)
        return phase_differs(&of, "another name of the scene");
    if (first->fps < model->fps || first->fps > model->fps)
        return phase_differs(&of, "another time.fps");
    if (model_shows_contact(first) != model_shows_contact(model))
        return phase_differs(&of,
                             "another contact.force, or contact that is not certified in both,");
    if (!same_hdf5(&first->hdf5, &model->hdf5))
        return phase_differs(&of, "another output.hdf5");
    int code = check_cloths(&of);
    if (!code)
        code = check_obstacles(&of);
    return code ? code : check_probes(&of);
}

/* ---- Settings ---- */

static int same_put_file(FILE *to, const char *phase, const char *path, struct cloth_error *error)
{
    unsigned char bytes[1 << 14];
    XXH64_state_t *hash = XXH64_createState();
    FILE *file = cloth_file_open(path);
    int code = CLOTH_OK;
    if (!hash)
        code = cloth_fail(error, CLOTH_E_MEMORY, "no memory for a hash");
    else if (!file)
        code = cloth_fail(error, CLOTH_E_INPUT, "cannot read %s again: %s", path, cloth_file_why());
    if (!code) {
        XXH64_reset(hash, 0);
        for (size_t n; (n = fread(bytes, 1, sizeof bytes, file)) > 0;)
            XXH64_update(hash, bytes, n);
        fprintf(to, "%sfile %s: %016jx\n", phase, path, (uintmax_t)XXH64_digest(hash));
    }
    if (file)
        fclose(file);
    XXH64_freeState(hash);
    return code;
}

/* The first file is the scene, which its settings stand for. */
static int put_phase(FILE *to, const struct phases *phases, uint32_t i, struct cloth_error *error)
{
    const struct model *model = phases->models + i;
    char phase[100] = "";
    int code = CLOTH_OK;
    if (phases->named)
        snprintf(phase, sizeof phase, "phase '%.60s': ", phases_label(phases, i));
    for (const char *line = model->settings; line && *line;) {
        const size_t n = strcspn(line, "\n");
        fprintf(to, "%s%.*s\n", phase, (int)n, line);
        line += n + (line[n] == '\n');
    }
    for (uint32_t k = 1; k < model->n_files && !code; k++)
        code = same_put_file(to, phase, model->files[k], error);
    return code;
}

char *phases_settings(const struct phases *phases, struct cloth_error *error)
{
    char *text = NULL;
    size_t size;
    int code = CLOTH_OK;
    FILE *to = open_memstream(&text, &size);
    if (to)
        fprintf(to, "version: %s\n", PACKAGE_STRING);
    if (to && phases->first_frame) /* which is the first one in the folder */
        fprintf(to, "first of --frames: %" PRIu64 "\n", phases->first_frame);
    for (uint32_t i = 0; to && i < phases->n && !code; i++)
        code = put_phase(to, phases, i, error);
    const int bad = !to || ferror(to), closed = to ? fclose(to) : 0;
    if (!code && (bad || closed))
        code = cloth_fail(error, CLOTH_E_MEMORY, "no memory for the settings of the scene");
    if (!code)
        return text;
    free(text);
    return NULL;
}

/* A line without its end, and how long its key is: up to the last ": ". */
static size_t key_length(const char *line, size_t n)
{
    size_t length = n;
    for (size_t i = 0; i + 1 < n; i++)
        if (line[i] == ':' && line[i + 1] == ' ') {
            length = i;
            if (strncmp(line, "phase '", 7) != 0 || i + 2 >= n || line[i - 1] != '\'')
                break;
        }
    return length;
}

static int settings_differ(const char *path, const char *now, const char *was,
                           struct cloth_error *error)
{
    const size_t n = strcspn(now, "\n"), m = strcspn(was, "\n");
    const size_t key = key_length(now, n), key_was = key_length(was, m);
    const char *only = "only time.end, and what changes no state, may be others";
    if (!strncmp(now, "version: ", 9))
        return cloth_fail(error, CLOTH_E_INPUT,
                          "%s is of another version, %.*s; this is " PACKAGE_STRING
                          ": go on with the one that wrote it",
                          path, (int)(m - key_was - 2), was + key_was + 2);
    if (key == key_was && !strncmp(now, was, key))
        return cloth_fail(error, CLOTH_E_INPUT,
                          "%s is of another scene: %.*s is %.*s there, here it is %.*s; %s", path,
                          (int)key, now, (int)(m - key_was - 2), was + key_was + 2,
                          (int)(n - key - 2), now + key + 2, only);
    const bool here = !*was || (*now && strcmp(now, was) < 0);
    return cloth_fail(error, CLOTH_E_INPUT, "%s is of another scene: %.*s is %s alone; %s", path,
                      (int)(here ? key : key_was), here ? now : was,
                      here ? "in this one" : "in that one", only);
}

int phases_compare(const char *path, const char *now, const void *was_bytes, size_t was_n,
                   struct cloth_error *error)
{
    char *was = cloth_alloc(was_n + 1, 1, error);
    if (!was)
        return CLOTH_E_MEMORY;
    memcpy(was, was_bytes, was_n);
    size_t line = 0, i = 0;
    for (; now[i] && now[i] == was[i]; i++)
        line = now[i] == '\n' ? i + 1 : line;
    const int code =
        now[i] == was[i] ? CLOTH_OK : settings_differ(path, now + line, was + line, error);
    free(was);
    return code;
}
