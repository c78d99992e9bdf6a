// SPDX-License-Identifier: Apache-2.0
#include "scene/readers/obj_scene.h"

#include "scene/readers/mtl_libraries.h"
#include "scene/readers/mtl_repair.h"
#include "scene/readers/mtl_rules.h"
#include "scene/readers/obj_colours.h"
#include "scene/readers/obj_reader.h"
#include "scene/text_scanner.h"

#include <fmt/format.h>
#include <map>
#include <optional>
#include <utility>

namespace clrt {

namespace {

using MtlLibrary = std::map<std::string, MtlMaterial>;

/// A writer that knows no other up than z; empty: none.
std::string z_up_writer(const std::string& head) {
    const std::pair<const char*, const char*> writers[] = {{"# Created by FreeCAD", "FreeCAD"},
                                                           {"# OpenSCAD obj exporter", "OpenSCAD"}};
    for (const auto& [comment, name] : writers)
        if (head.find(comment) != std::string::npos)
            return name;
    return "";
}

/// A usemtl statement.
struct MaterialUse {
    std::string name; ///< "": faces without one
    SourcePlace place;
    std::optional<SourcePlace> first_colour; ///< where its triangles have coloured vertices
};

MaterialDescription describe_defined(const MtlMaterial& mtl, const MaterialUse& use,
                                     const ReadContext& context) {
    const MtlMaterial meant =
        context.mtl == MtlReading::AUTO ? repair_material(mtl, context.pictures, context.notices) : mtl;
    if (!use.first_colour)
        return describe_mtl(meant, context.notices);
    if (!meant.map_kd)
        return describe_mtl(with_vertex_colours(meant, *use.first_colour), context.notices);
    MaterialDescription material = describe_mtl(meant, context.notices);
    material.surface_remarks.push_back(
        {"map_Kd is taken, the vertex colours have no effect", meant.map_kd->place});
    return material;
}

/// A name that no library defines is grey, with a notice.
MaterialDescription describe_undefined(const MaterialUse& use, const ReadContext& context) {
    if (!use.name.empty())
        context.notices.add(
            fmt::format("usemtl {}: no library defines it, matte {} is taken", clrt::quoted(use.name),
                        use.first_colour ? "with the colours of the vertices" : "grey (Kd 0.8)"),
            use.place);
    MaterialDescription material;
    if (use.first_colour) {
        material = describe_mtl(with_vertex_colours({}, *use.first_colour), context.notices);
        material.rule = "no material: matte, Kd of the vertices";
    }
    material.name = use.name;
    material.place = use.place;
    return material;
}

/// The materials of the mesh, by the libraries.
std::vector<MaterialDescription> describe_materials(const ObjMesh& mesh, const std::string& path,
                                                    const std::vector<bool>& coloured,
                                                    const MtlLibrary& library, const ReadContext& context) {
    std::vector<MaterialDescription> materials;
    for (size_t i = 0; i < mesh.material_names.size(); ++i) {
        MaterialUse use{mesh.material_names[i], {path, mesh.material_lines[i]}, std::nullopt};
        if (coloured[i])
            use.first_colour = SourcePlace{path, mesh.first_colour_line};
        const auto found = library.find(use.name);
        materials.push_back(found != library.end() ? describe_defined(found->second, use, context)
                                                   : describe_undefined(use, context));
    }
    return materials;
}

} // namespace

SceneDescription read_obj_scene(SceneFile file, const ReadContext& context) {
    const std::string path = file.name;
    ObjMesh mesh = read_obj(std::move(file), context.progress);
    for (const std::string& line : mesh.notices)
        context.notices.add_line(line);

    SceneDescription scene;
    std::vector<bool> coloured = coloured_materials(mesh);
    scene.colour_remarks = decode_vertex_colours(mesh, path);
    if (mesh.colours.empty())
        coloured.assign(mesh.material_names.size(), false);

    const MtlLibrary library = read_mtl_libraries(path, mesh.libraries, context.notices, scene.files);
    if (context.mtl == MtlReading::AUTO)
        note_writers(library, context.notices);
    scene.materials = describe_materials(mesh, path, coloured, library, context);
    if (const std::string writer = z_up_writer(mesh.head); !writer.empty())
        scene.z_up_reason = fmt::format("it is by {}, whose up is z", writer);
    scene.dropped_faces = mesh.dropped_faces;
    scene.mesh = std::move(mesh);
    return scene;
}

} // namespace clrt
