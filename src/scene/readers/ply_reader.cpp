// SPDX-License-Identifier: Apache-2.0
#include "scene/readers/ply_reader.h"

#include "colour.h"
#include "error.h"
#include "scene/readers/coordinate.h"
#include "scene/readers/ply_values.h"
#include "scene/triangulate.h"
#include "scene/vectors.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>

namespace clrt {

namespace {

/// Between two updates of the progress line.
constexpr size_t ELEMENTS_A_STEP = size_t(1) << 16;

/// What the properties of a vertex are, in the order of PlyVertexReader's numbers.
enum VertexNumber : size_t { X, Y, Z, NX, NY, NZ, U, V, RED, GREEN, BLUE, VERTEX_NUMBERS };

struct VertexName {
    const char* name;
    VertexNumber number;
};
constexpr VertexName VERTEX_NAMES[] = {{"x", X},
                                       {"y", Y},
                                       {"z", Z},
                                       {"nx", NX},
                                       {"ny", NY},
                                       {"nz", NZ},
                                       {"u", U},
                                       {"v", V},
                                       {"s", U},
                                       {"t", V},
                                       {"texture_u", U},
                                       {"texture_v", V},
                                       {"red", RED},
                                       {"green", GREEN},
                                       {"blue", BLUE},
                                       {"diffuse_red", RED},
                                       {"diffuse_green", GREEN},
                                       {"diffuse_blue", BLUE}};

/// The largest value of a colour's type.
double largest_colour(PlyType type) {
    switch (type) {
    case PlyType::UINT8:
        return 255;
    case PlyType::UINT16:
        return 65535;
    default:
        return 1;
    }
}

bool is_polygon_list(const PlyProperty& property) {
    return property.is_list && (property.name == "vertex_indices" || property.name == "vertex_index");
}

/// Reads the elements into a mesh.
class PlyMesh {
public:
    PlyMesh(PlyValues& values, const SceneFile& file, const ReadContext& context)
        : values_(values), file_(file), context_(context) {
        mesh_.object_names.emplace_back();
    }

    void read(const PlyElement& element) {
        if (element.properties.empty())
            return;
        // Attributes are of all positions: what a second list of vertices would add is skipped.
        const bool is_vertex = element.name == "vertex" && mesh_.positions.empty(),
                   is_strip = element.name == "tristrips";
        for (size_t i = 0; i < element.count; ++i) {
            if (i % ELEMENTS_A_STEP == 0)
                context_.progress.update({"load", values_.progress()});
            if (is_vertex)
                read_vertex(element);
            else
                read_face(element, is_strip);
        }
    }

    size_t dropped() const { return dropped_; }
    Mesh take() { return std::move(mesh_); }

private:
    void skip_list(const PlyProperty& property) {
        for (size_t left = values_.next_count(property.count_type); left > 0; --left)
            values_.next(property.type);
    }

    void read_vertex(const PlyElement& element) {
        std::array<double, VERTEX_NUMBERS> n{};
        std::array<bool, VERTEX_NUMBERS> has{};
        for (const PlyProperty& property : element.properties) {
            if (property.is_list) {
                skip_list(property);
                continue;
            }
            const double value = values_.next(property.type);
            for (const VertexName& row : VERTEX_NAMES)
                if (property.name == row.name) {
                    n[row.number] = row.number < RED ? value : value / largest_colour(property.type);
                    has[row.number] = true;
                }
        }
        if (!has[X] || !has[Y] || !has[Z])
            values_.fail("vertices with x, y and z", "others");
        mesh_.positions.emplace_back(as_coordinate(n[X]), as_coordinate(n[Y]), as_coordinate(n[Z]));
        if (has[NX] && has[NY] && has[NZ])
            mesh_.normals.emplace_back(n[NX], n[NY], n[NZ]);
        if (has[U] && has[V])
            mesh_.uvs.emplace_back(n[U], n[V]);
        if (has[RED] && has[GREEN] && has[BLUE])
            mesh_.colours.emplace_back(linear(n[RED]), linear(n[GREEN]), linear(n[BLUE]));
    }

    static double linear(double srgb) { return srgb > 0 ? srgb_to_linear(std::min(srgb, 1.0)) : 0; }

    void read_face(const PlyElement& element, bool is_strip) {
        for (const PlyProperty& property : element.properties) {
            if (!property.is_list)
                values_.next(property.type);
            else if (!is_polygon_list(property) || (element.name != "face" && !is_strip))
                skip_list(property);
            else if (is_strip)
                read_strips(property);
            else
                read_polygon(property);
        }
    }

    u32 vertex_index(double value) const {
        if (!(value >= 0 && value < double(mesh_.positions.size())))
            values_.fail(fmt::format("the index of one of {} vertices", mesh_.positions.size()),
                         fmt::format("{}", value));
        return u32(value);
    }

    void read_polygon(const PlyProperty& property) {
        polygon_.clear();
        for (size_t left = values_.next_count(property.count_type); left > 0; --left)
            polygon_.push_back(vertex_index(values_.next(property.type)));
        corners_.clear();
        for (const u32 v : polygon_)
            corners_.push_back(mesh_.positions[v]);
        const bool finite =
            std::all_of(corners_.begin(), corners_.end(), [](const glm::dvec3& p) { return is_finite(p); });
        if (corners_.size() < 3 || !finite) {
            ++dropped_;
            return;
        }
        if (!triangulate(corners_, cut_))
            context_.notices.add(
                "a face that crosses itself or has no area is cut into triangles that may overlap",
                {file_.name, 0});
        for (size_t i = 0; i < cut_.size(); i += 3)
            add_triangle(polygon_[cut_[i]], polygon_[cut_[i + 1]], polygon_[cut_[i + 2]]);
    }

    /// Strips of one list; -1 ends one. Every second triangle is turned round.
    void read_strips(const PlyProperty& property) {
        std::vector<u32> strip;
        for (size_t left = values_.next_count(property.count_type); left > 0; --left) {
            const double value = values_.next(property.type);
            if (value == -1) {
                strip.clear();
                continue;
            }
            strip.push_back(vertex_index(value));
            const size_t n = strip.size();
            if (n >= 3)
                add_triangle(strip[n - 3], strip[n % 2 ? n - 2 : n - 1], strip[n % 2 ? n - 1 : n - 2]);
        }
    }

    void add_triangle(u32 a, u32 b, u32 c) {
        const u32 v[3] = {a, b, c};
        if (!std::all_of(v, v + 3, [&](u32 i) { return is_finite(mesh_.positions[i]); })) {
            ++dropped_;
            return;
        }
        MeshTriangle triangle{};
        for (size_t k = 0; k < 3; ++k) {
            triangle.v[k] = v[k];
            triangle.n[k] = mesh_.normals.empty() ? NO_INDEX : v[k];
            triangle.t[k] = mesh_.uvs.empty() ? NO_INDEX : v[k];
        }
        mesh_.triangles.push_back(triangle);
    }

    PlyValues& values_;
    const SceneFile& file_;
    const ReadContext& context_;
    Mesh mesh_;
    std::vector<u32> polygon_, cut_;
    std::vector<glm::dvec3> corners_;
    size_t dropped_ = 0;
};

MaterialDescription ply_material(const std::string& path, bool coloured) {
    MaterialDescription material;
    material.place = {path, 0};
    if (!coloured)
        return material;
    TextureUse vertices;
    vertices.file = "vertex colours";
    vertices.place = material.place;
    vertices.by_vertex = true;
    material.base = {glm::dvec3(1), vertices};
    material.rule = "PLY: matte, of the colours of the vertices";
    return material;
}

} // namespace

SceneDescription read_ply_scene(SceneFile file, const ReadContext& context) {
    const PlyHeader header = read_ply_header(file.bytes, file.name);
    PlyValues values(header, file.bytes, file.name);
    PlyMesh mesh(values, file, context);
    for (const PlyElement& element : header.elements)
        mesh.read(element);
    SceneDescription scene;
    scene.dropped_faces = mesh.dropped();
    scene.mesh = mesh.take();
    if (scene.mesh.triangles.empty())
        throw SceneError(
            file.name, 0,
            fmt::format("the file has no faces to render (points are none); faces that are left out: {}",
                        scene.dropped_faces));
    scene.materials.push_back(ply_material(file.name, !scene.mesh.colours.empty()));
    context.progress.update({"load", 1});
    return scene;
}

} // namespace clrt
