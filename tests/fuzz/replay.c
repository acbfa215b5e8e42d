/*
 * Feeds a fuzzer the files of its corpus, tests/fuzz/corpus/NAME for the program fuzz_NAME, or the
 * files named on the command line. The last file named in the log is the one that broke it.
 */
#include "fuzz.h"

#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PATH_SIZE = 1024, LARGEST = 1 << 20 };

static void stop(const char *path) {
    fprintf(stderr, "%s: %s\n", path, strerror(errno));
    exit(1);
}

static void feed(const char *path) {
    FILE *file = fopen(path, "rb");
    uint8_t *data = malloc(LARGEST);
    if (!file || !data)
        stop(path);
    size_t size = fread(data, 1, LARGEST, file);
    if (ferror(file))
        stop(path);
    fclose(file);
    /* A block of the size itself: reading past the end of the input is seen. */
    uint8_t *exact = realloc(data, size ? size : 1);
    printf("%s\n", path);
    fflush(stdout);
    LLVMFuzzerTestOneInput(exact ? exact : data, size);
    free(exact ? exact : data);
}

static int is_file(const struct dirent *entry) {
    return entry->d_name[0] != '.';
}

static int feed_all(const char *directory) {
    char path[PATH_SIZE];
    struct dirent **entries;
    int count = scandir(directory, &entries, is_file, alphasort);
    if (count < 0)
        stop(directory);
    for (int i = 0; i < count; i++) {
        snprintf(path, sizeof path, "%s/%s", directory, entries[i]->d_name);
        feed(path);
        free(entries[i]);
    }
    free(entries);
    return count;
}

int main(int argc, char **argv) {
    const char *slash = strrchr(argv[0], '/'), *name = slash ? slash + 1 : argv[0];
    char directory[PATH_SIZE / 2];
    for (int i = 1; i < argc; i++)
        feed(argv[i]);
    if (argc > 1)
        return 0;
    snprintf(directory, sizeof directory, "tests/fuzz/corpus/%s", name + strlen("fuzz_"));
    printf("[ RUN      ] %s\n", name);
    if (feed_all(directory) == 0) {
        fprintf(stderr, "%s: no files\n", directory);
        return 1;
    }
    printf("[       OK ] %s\n", name);
    return 0;
}
