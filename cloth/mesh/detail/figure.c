/* Which files are read through Assimp: known by name, so that OBJ files may have any other. */
#include "cloth/mesh/detail/figure.h"

#include <string.h>
#include <strings.h>

size_t mesh_figure_path(const char *path)
{
    static const char *const endings[] = {".glb", ".gltf", ".fbx", ".dae", ".ply", ".stl"};
    for (const char *dot = strchr(path, '.'); dot; dot = strchr(dot + 1, '.'))
        for (size_t i = 0; i < sizeof endings / sizeof *endings; i++) {
            const size_t n = strlen(endings[i]);
            if (!strncasecmp(dot, endings[i], n) && (!dot[n] || dot[n] == '#'))
                return (size_t)(dot - path) + n;
        }
    return 0;
}
