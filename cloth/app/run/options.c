/* Settings that options do not give come from the environment: they are read before the options,
 * and judged after them. */
#include "cloth/app/run/options.h"

#include "cloth/base/file.h"

#include <dirent.h>
#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* ---- Values ---- */

/* A number up to *end, if one begins there. */
static bool read_end(const char *text, uint64_t *number, char **end)
{
    *end = (char *)(uintptr_t)text;
    if (*text < '0' || *text > '9')
        return true;
    errno = 0;
    *number = strtoull(text, end, 10);
    return !errno && *number <= INT64_MAX;
}

bool options_range(const char *text, uint64_t *first, uint64_t *last)
{
    char *end;
    return read_end(text, first, &end) && *end == ':' && read_end(end + 1, last, &end) && !*end &&
           *first <= *last;
}

/* ---- The environment ---- */

static const char *option_name_of(const char *variable, const char *const *names)
{
    const char *name = getenv(variable);
    return name ? name : names[0];
}

void environment_begin(struct simulate_options *run)
{
    run->runtime = duite_options_default();
    run->last_frame = UINT64_MAX;
    run->report = run->runtime.report; /* ours has more */
    run->runtime.report = NULL;
    run->scheduler_name = option_name_of("DUITE_SCHEDULER", duite_scheduler_names());
    run->mapping_name = option_name_of("DUITE_MAPPING", duite_mapping_names());
    run->balance_name = option_name_of("DUITE_BALANCE", duite_balancer_names());
}

static int wrong_variable(struct cloth_error *error, const char *variable, const char *why)
{
    return cloth_fail(error, CLOTH_E_INPUT, "%s=%s in the environment: %s", variable,
                      getenv(variable), why);
}

/* A policy is NULL, a number the largest of its type, only if the environment made it so. */
int environment_check(const struct simulate_options *run, struct cloth_error *error)
{
    const duite_options *runtime = &run->runtime, defaults = duite_options_default();
    char threads[60];
    if (!runtime->scheduler && !duite_scheduler_find(run->scheduler_name))
        return wrong_variable(error, "DUITE_SCHEDULER", duite_message());
    if (!runtime->mapping && !duite_mapping_find(run->mapping_name))
        return wrong_variable(error, "DUITE_MAPPING", duite_message());
    if (!runtime->balance && !duite_balancer_find(run->balance_name))
        return wrong_variable(error, "DUITE_BALANCE", duite_message());
    snprintf(threads, sizeof threads, "a whole number from 0 to %d is expected", DUITE_MAX_THREADS);
    if (runtime->threads == UINT_MAX)
        return wrong_variable(error, "DUITE_THREADS", threads);
    if (runtime->seed == UINT64_MAX && defaults.seed == UINT64_MAX)
        return wrong_variable(error, "DUITE_SEED",
                              "a whole number from 0 to 18446744073709551614 is expected");
    if (runtime->trace && !*runtime->trace)
        return wrong_variable(error, "DUITE_TRACE", "the name of a file is expected");
    if (run->report && !*run->report)
        return wrong_variable(error, "DUITE_REPORT", "the name of a file is expected");
    return CLOTH_OK;
}

static void print_names(FILE *file, const char *const *names)
{
    for (size_t i = 0; names[i]; i++)
        fprintf(file, "%s%s", i == 0 ? "" : names[i + 1] ? ", " : " or ", names[i]);
}

char *environment_help(int key, const char *text, void *input)
{
    static const struct {
        const char *word;
        const char *const *(*names)(void);
    } lists[] = {{"SCHEDULERS", duite_scheduler_names},
                 {"MAPPINGS", duite_mapping_names},
                 {"BALANCERS", duite_balancer_names}};
    (void)key, (void)input;
    for (size_t i = 0; text && i < sizeof lists / sizeof *lists; i++) {
        const char *at = strstr(text, lists[i].word);
        char *filled = NULL;
        size_t size = 0;
        FILE *file = at ? open_memstream(&filled, &size) : NULL;
        if (!file)
            continue;
        fprintf(file, "%.*s", (int)(at - text), text);
        print_names(file, lists[i].names());
        fputs(at + strlen(lists[i].word), file);
        if (fclose(file) == 0)
            return filled;
        free(filled);
    }
    return (char *)text;
}

/* ---- Shipped scenes ---- */

static const char GALLERY[] = "gallery/"; /* the only folder among them */

/* The folder beside the program comes first, so that an installed tree may be moved; configure's
 * folder comes second. */

/* DIR/../share/duite/scenes of the program's DIR; NULL: unknown. To be freed. */
static char *folder_beside(void)
{
    char program[PATH_MAX], *folder = NULL;
    const ssize_t n = readlink("/proc/self/exe", program, sizeof program - 1);
    if (n <= 0)
        return NULL;
    program[n] = '\0';
    char *slash = strrchr(program, '/');
    if (!slash)
        return NULL;
    *slash = '\0';
    return asprintf(&folder, "%s/../share/duite/scenes", program) < 0 ? NULL : folder;
}

/* The folder of the shipped scenes, to be freed; NULL: there is none. */
static char *shipped_folder(void)
{
    char *folder = folder_beside();
    if (folder && access(folder, R_OK | X_OK) == 0)
        return folder;
    free(folder);
    return access(SHIPPED_SCENES, R_OK | X_OK) == 0 ? strdup(SHIPPED_SCENES) : NULL;
}

char *shipped_scene(const char *name)
{
    char *path = NULL, *folder = NULL;
    const bool gallery = strncmp(name, GALLERY, sizeof GALLERY - 1) == 0;
    if (strchr(name + (gallery ? sizeof GALLERY - 1 : 0), '/') || access(name, F_OK) == 0)
        return NULL;
    folder = shipped_folder();
    if (folder && asprintf(&path, "%s/%s", folder, name) < 0)
        path = NULL;
    if (path && access(path, R_OK) != 0) {
        free(path);
        path = NULL;
    }
    free(folder);
    return path;
}

/* The first sentence, as far as it stands in the line. */
static void print_line(FILE *file, const char *name, const char *line)
{
    const char *text = line + strspn(line, "# "), *end = text;
    while (*end && *end != '\n' && !(*end == '.' && (end[1] == ' ' || end[1] == '\n')))
        end++;
    fprintf(file, "%-26s %.*s%s\n", name, (int)(end - text), text, *end == '.' ? "." : " ...");
}

static size_t print_scene(FILE *file, const char *folder, const char *name)
{
    char *path = NULL, line[400] = "";
    FILE *scene = asprintf(&path, "%s/%s", folder, name) < 0 ? NULL : cloth_file_open(path);
    const size_t n = scene && fgets(line, sizeof line, scene) ? 1 : 0;
    if (n)
        print_line(file, name, line);
    if (scene)
        fclose(scene);
    free(path);
    return n;
}

static int is_scene(const struct dirent *entry)
{
    const size_t n = strlen(entry->d_name);
    return n > 5 && strcmp(entry->d_name + n - 5, ".yaml") == 0;
}

/* Those of the folder, or of one in it. */
static size_t print_scenes(FILE *file, const char *folder, const char *inner)
{
    struct dirent **scenes = NULL;
    char *path = NULL, *name;
    size_t printed = 0;
    const int made = folder ? asprintf(&path, "%s/%s", folder, inner) : -1;
    const int n = made < 0 ? 0 : scandir(path, &scenes, is_scene, alphasort);
    for (int i = 0; i < n; i++) {
        if (asprintf(&name, "%s%s", inner, scenes[i]->d_name) >= 0) {
            printed += print_scene(file, folder, name);
            free(name);
        }
        free(scenes[i]);
    }
    if (made >= 0)
        free(path);
    free(scenes);
    return printed;
}

size_t shipped_print(FILE *file)
{
    char *folder = shipped_folder();
    size_t printed = print_scenes(file, folder, "");
    printed += print_scenes(file, folder, GALLERY);
    free(folder);
    return printed;
}
