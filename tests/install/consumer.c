/* A host program as small as can be: built against the installed library by run.sh. */
#include <ilsa/ilsa.h>
#include <stdio.h>
#include <string.h>

int main(void) {
    char header[32];
    snprintf(header, sizeof header, "%d.%d.%d", ILSA_VERSION_MAJOR, ILSA_VERSION_MINOR,
             ILSA_VERSION_PATCH);
    if (strcmp(header, ilsa_version_string()) != 0) {
        fprintf(stderr, "header %s, library %s\n", header, ilsa_version_string());
        return 1;
    }

    ilsa_mesh *mesh = NULL;
    ilsa_mesh_def def = ilsa_mesh_def_default();
    def.nx = def.ny = 31;
    def.dx = def.dy = 1.0;
    ilsa_status status = ilsa_mesh_create(&def, &mesh);
    ilsa_mesh_destroy(&mesh);
    if (status != ILSA_OK) {
        fprintf(stderr, "%s\n", ilsa_status_text(status));
        return 1;
    }
    printf("libilsa %s\n", ilsa_version_string());
    return 0;
}
