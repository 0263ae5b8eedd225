/* Two runs of the same settings and files have the same states, so a checkpoint is used only where
 * they are the same. */
#include "cloth/app/run/phases.h"
#include "cloth/base/file.h"
#include "cloth/base/memory.h"

#include <config.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <xxhash.h>

static int phases_settings_put_file(FILE *to, const char *phase, const char *path,
                                    struct cloth_error *error)
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
        snprintf(phase, sizeof phase, "phase '%.60s': ", phases->done[i].name);
    for (const char *line = model->settings; line && *line;) {
        const size_t n = strcspn(line, "\n");
        fprintf(to, "%s%.*s\n", phase, (int)n, line);
        line += n + (line[n] == '\n');
    }
    for (uint32_t k = 1; k < model->n_files && !code; k++)
        code = phases_settings_put_file(to, phase, model->files[k], error);
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

static int phases_settings_differs(const char *path, const char *now, const char *was,
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
        now[i] == was[i] ? CLOTH_OK : phases_settings_differs(path, now + line, was + line, error);
    free(was);
    return code;
}
