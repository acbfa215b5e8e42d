#include "outfile.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static int fail(const char *path, int error) {
    fprintf(stderr, "ilsa-run: %s: %s\n", path, strerror(error));
    return 0;
}

static char *join(const char *directory, const char *name, const char *end) {
    size_t size = strlen(directory) + strlen(name) + strlen(end) + 2;
    char *path = malloc(size);
    if (path)
        snprintf(path, size, "%s/%s%s", directory, name, end);
    return path;
}

static void forget(outfile *file) {
    free(file->path);
    free(file->part);
    *file = (outfile){0};
}

/* Whether what has been flushed could be kept under its final name. */
static int keep_flushed(const outfile *file) {
    return file->flushed > 0 && truncate(file->part, file->flushed) == 0 &&
           rename(file->part, file->path) == 0;
}

/* Called with errno set. */
static int give_up(outfile *file) {
    int error = errno ? errno : EIO;
    if (file->stream)
        fclose(file->stream);
    if (file->part && !keep_flushed(file))
        unlink(file->part);
    fail(file->path ? file->path : "result file", error);
    forget(file);
    return 0;
}

int outfile_open(outfile *file, const char *directory, const char *name) {
    *file = (outfile){.path = join(directory, name, ""), .part = join(directory, name, ".part")};
    if (file->path && file->part)
        file->stream = fopen(file->part, "w");
    return file->stream ? 1 : give_up(file);
}

/* All is on its way to the disk. */
static int write_out(outfile *file) {
    errno = 0;
    return fflush(file->stream) == 0 && !ferror(file->stream) ? 1 : give_up(file);
}

/* A file that has been removed still takes what is written. */
static int is_there(const outfile *file) {
    struct stat info;
    return fstat(fileno(file->stream), &info) == 0 && info.st_nlink > 0;
}

int outfile_flush(outfile *file) {
    if (!write_out(file))
        return 0;
    if (!is_there(file)) {
        errno = ENOENT;
        return give_up(file);
    }
    file->flushed = ftell(file->stream);
    return 1;
}

int outfile_close(outfile *file) {
    if (!write_out(file))
        return 0;
    FILE *stream = file->stream;
    file->stream = NULL;
    if (fclose(stream) != 0 || rename(file->part, file->path) != 0)
        return give_up(file);
    forget(file);
    return 1;
}

int output_written(void) {
    errno = 0;
    return fflush(stdout) == 0 && !ferror(stdout) ? 1
                                                  : fail("standard output", errno ? errno : EIO);
}

void output_guard(void) {
    for (int fd = 0; fd <= 2; fd++)
        if (fcntl(fd, F_GETFD) == -1 && errno == EBADF)
            open("/dev/null", fd == 0 ? O_WRONLY : O_RDONLY);
}

int directory_make(const char *path) {
    struct stat info;
    char *copy = join(path, "", "");
    if (!copy)
        return fail(path, ENOMEM);
    for (char *slash = strchr(copy + 1, '/'); slash; slash = strchr(slash + 1, '/')) {
        *slash = '\0';
        if (mkdir(copy, 0777) != 0 && errno != EEXIST) {
            fail(copy, errno);
            free(copy);
            return 0;
        }
        *slash = '/';
    }
    free(copy);
    if (stat(path, &info) != 0)
        return fail(path, errno);
    return S_ISDIR(info.st_mode) ? 1 : fail(path, ENOTDIR);
}

/* front_000.csv and its kin: a stem that this program writes, three digits or more, an extension.
 */
static int is_result(const char *name) {
    static const char *const whole[] = {"history.csv", "summary.txt", "run.pvd", "plot.gp"};
    static const char *const stems[] = {"front_", "survey_", "line_x_", "line_y_", "fields_"};
    for (size_t i = 0; i < sizeof whole / sizeof *whole; i++)
        if (strcmp(name, whole[i]) == 0)
            return 1;
    for (size_t i = 0; i < sizeof stems / sizeof *stems; i++) {
        size_t length = strlen(stems[i]);
        if (strncmp(name, stems[i], length) != 0)
            continue;
        size_t digits = strspn(name + length, "0123456789");
        const char *end = name + length + digits;
        return digits >= 3 && (strcmp(end, ".csv") == 0 || strcmp(end, ".vti") == 0);
    }
    return 0;
}

void directory_clear(const char *path) {
    DIR *directory = opendir(path);
    if (!directory)
        return;
    for (const struct dirent *entry = readdir(directory); entry; entry = readdir(directory)) {
        char *file = is_result(entry->d_name) ? join(path, entry->d_name, "") : NULL;
        if (file)
            unlink(file);
        free(file);
    }
    closedir(directory);
}

const char *numbered_name(char *name, const char *stem, int number, const char *extension) {
    snprintf(name, NAME_SIZE, "%s_%03d.%s", stem, number, extension);
    return name;
}
