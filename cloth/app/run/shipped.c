/* The folder beside the program comes first, so that an installed tree may be moved; configure's
 * folder comes second. */
#include "cloth/app/run/shipped.h"

#include "cloth/base/file.h"

#include <dirent.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

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
    if (strchr(name, '/') || access(name, F_OK) == 0)
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
    fprintf(file, "%-16s %.*s%s\n", name, (int)(end - text), text, *end == '.' ? "." : " ...");
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

size_t shipped_print(FILE *file)
{
    char *folder = shipped_folder();
    struct dirent **scenes = NULL;
    size_t printed = 0;
    const int n = folder ? scandir(folder, &scenes, is_scene, alphasort) : 0;
    for (int i = 0; i < n; i++) {
        printed += print_scene(file, folder, scenes[i]->d_name);
        free(scenes[i]);
    }
    free(scenes);
    free(folder);
    return printed;
}
