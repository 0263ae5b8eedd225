/* The folder may not be there yet: then its nearest parent that exists is on the same file system.
 */
#include "cloth/output/files/files.h"
#include "cloth/output/output.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/statvfs.h>

/* Bytes of the files of an earlier run, which are replaced. */
static double replaced(const char *folder)
{
    static const char *const name[] = {"cloth.pc2", "contact.pc2", "colours.bin", "probes.csv"};
    double bytes = 0;
    for (size_t i = 0; i < sizeof name / sizeof *name; i++) {
        struct stat status;
        if (stat(output_path(folder, "%s", name[i]).text, &status) == 0)
            bytes += (double)status.st_size;
    }
    return bytes;
}

/* Describes the disk of the folder, or of the nearest parent that exists. */
static int disk_of(char *path, struct statvfs *disk)
{
    while (statvfs(path, disk) != 0) {
        char *slash = strrchr(path, '/');
        if (!slash)
            return statvfs(".", disk);
        if (slash == path)
            return statvfs("/", disk);
        *slash = '\0';
    }
    return 0;
}

double output_room(const char *folder)
{
    struct statvfs disk;
    char *path = strdup(folder);
    const bool known = path && disk_of(path, &disk) == 0 && disk.f_blocks > 0;
    free(path);
    return known ? (double)disk.f_bavail * (double)disk.f_frsize + replaced(folder) : INFINITY;
}
