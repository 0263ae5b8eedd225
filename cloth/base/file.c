/* ESPIPE stands for a file that is not plain: no call that opens a file sets it. */
#include "cloth/base/file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* O_NONBLOCK: the system would wait for the other end of a pipe. */
FILE *cloth_file_open(const char *path)
{
    struct stat status;
    const int handle = open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    if (handle < 0)
        return NULL;
    FILE *file = NULL;
    int reason = 0;
    if (fstat(handle, &status) != 0)
        reason = errno;
    else if (!S_ISREG(status.st_mode))
        reason = S_ISDIR(status.st_mode) ? EISDIR : ESPIPE;
    else if (!(file = fdopen(handle, "rb")))
        reason = errno;
    if (!file)
        close(handle);
    errno = reason;
    return file;
}

const char *cloth_file_why(void)
{
    return errno == ESPIPE ? "it is no plain file, but a pipe, a device or the like"
                           : strerror(errno);
}

int cloth_file_read(FILE *file, size_t most, char **bytes, size_t *size)
{
    size_t room = 0;
    *bytes = NULL;
    *size = 0;
    for (size_t got = 1; got; *size += got) {
        if (*size > most)
            return CLOTH_E_INPUT;
        if (*size + 1 >= room) { /* one is for the zero */
            room = room ? 2 * room : 65536;
            char *more = realloc(*bytes, room);
            if (!more)
                return CLOTH_E_MEMORY;
            *bytes = more;
        }
        errno = 0;
        got = fread(*bytes + *size, 1, room - 1 - *size, file);
    }
    (*bytes)[*size] = 0;
    return ferror(file) ? CLOTH_E_IO : CLOTH_OK;
}
