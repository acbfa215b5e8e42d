// A C++ host: the headers compile as C++ and the names link.
#include <cstdio>
#include <ilsa/ilsa.h>
#include <memory>

struct mesh_destroy {
    void operator()(ilsa_mesh *mesh) const {
        ilsa_mesh_destroy(&mesh);
    }
};

int main() {
    ilsa_mesh_def def = ilsa_mesh_def_default();
    def.nx = def.ny = 31;
    def.dx = def.dy = 1.0;
    ilsa_mesh *handle = nullptr;
    const ilsa_status status = ilsa_mesh_create(&def, &handle);
    const std::unique_ptr<ilsa_mesh, mesh_destroy> mesh(handle);
    if (status != ILSA_OK) {
        std::fprintf(stderr, "%s\n", ilsa_status_text(status));
        return 1;
    }
    std::printf("libilsa %s, C++\n", ilsa_version_string());
    return 0;
}
