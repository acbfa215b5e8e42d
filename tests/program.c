#include "program.h"

#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

static void fail(const char *what) {
    fprintf(stderr, "test programs: %s: %s\n", what, strerror(errno));
    exit(99);
}

static char directory[] = "/tmp/ilsa-test-XXXXXX";
static int made;

static void remove_directory(void) {
    char command[64];
    snprintf(command, sizeof command, "rm -rf '%s'", directory);
    if (system(command) != 0)
        fprintf(stderr, "test programs: %s is left behind\n", directory);
}

const char *program_directory(void) {
    if (!made && !mkdtemp(directory))
        fail(directory);
    if (!made)
        atexit(remove_directory);
    made = 1;
    return directory;
}

const char *program_path(const char *name) {
    static char paths[4][256];
    static int next;
    char *path = paths[next++ % 4];
    snprintf(path, sizeof paths[0], "%s/%s", program_directory(), name);
    return path;
}

void program_write(const char *name, const char *text) {
    FILE *file = fopen(program_path(name), "w");
    if (!file || fputs(text, file) == EOF || fclose(file) != 0)
        fail(name);
}

char *program_read(const char *name) {
    FILE *file = fopen(program_path(name), "r");
    if (!file)
        return NULL;
    size_t size = 0, room = 1 << 16;
    char *text = malloc(room);
    while (text && (size += fread(text + size, 1, room - size - 1, file)) == room - 1) {
        char *more = realloc(text, room *= 2);
        if (!more)
            free(text);
        text = more;
    }
    if (!text || ferror(file))
        fail(name);
    fclose(file);
    text[size] = '\0';
    return text;
}

int program_exists(const char *name) {
    return access(program_path(name), F_OK) == 0;
}

/* $ILSA_BIN is relative to the project root, where tests start. */
const char *program_ilsa_run(void) {
    static char path[2 * PATH_MAX];
    const char *bin = getenv("ILSA_BIN");
    char here[PATH_MAX] = "";
    if (*path)
        return path;
    if (!bin || !*bin)
        bin = "build/bin";
    if (*bin != '/' && !getcwd(here, sizeof here))
        fail("getcwd");
    snprintf(path, sizeof path, "%s/%s/ilsa-run", here, bin);
    if (access(path, X_OK) != 0)
        fail(path);
    return path;
}

int program_run(const char *command, char *output, size_t size) {
    static const char head[] = "ilsa-run";
    char line[4 * PATH_MAX];
    int ours = strncmp(command, head, sizeof head - 1) == 0;
    snprintf(line, sizeof line, "cd '%s' && %s%s%s%s 2>&1", program_directory(), ours ? "'" : "",
             ours ? program_ilsa_run() : command, ours ? "'" : "",
             ours ? command + sizeof head - 1 : "");
    FILE *pipe = popen(line, "r");
    if (!pipe)
        fail(command);
    size_t used = fread(output, 1, size - 1, pipe);
    output[used] = '\0';
    int status = pclose(pipe);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}
