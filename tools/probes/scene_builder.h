// SPDX-License-Identifier: Apache-2.0
// Small scenes for tests as OBJ and MTL text: quads, boxes, icospheres and their materials.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

namespace clrt {

/// Which side of a closed body is its front.
enum class Facing { OUTWARD, INWARD };
/// Whether a body has vn statements.
enum class Shading { FLAT, SMOOTH };

/// Writes an OBJ and its MTL face by face. Faces are counter-clockwise seen from their front.
class SceneBuilder {
public:
    /// Puts lines in front of the materials, such as the comment that names their writer.
    SceneBuilder& header(const std::string& lines);
    /// Defines a material; `keys` are its lines, such as "Kd 1 1 1\nNi 1.5".
    SceneBuilder& material(const std::string& name, const std::string& keys);
    /// Faces from here on have this material.
    SceneBuilder& use(const std::string& name);

    /// A polygon without normals and texture coordinates.
    SceneBuilder& polygon(const std::vector<glm::dvec3>& corners);
    /// A quad whose corners have the texture coordinates (0,0), (1,0), (1,1), (0,1).
    SceneBuilder& textured_quad(const std::vector<glm::dvec3>& corners);
    /// A square in the plane y = height, centred on the y axis; its front is above.
    SceneBuilder& floor(double half_size, double height = 0);
    /// Six quads.
    SceneBuilder& box(const glm::dvec3& low, const glm::dvec3& high, Facing facing = Facing::OUTWARD);
    /// An icosahedron whose triangles are cut in four `subdivisions` times, corners on the sphere.
    SceneBuilder& icosphere(const glm::dvec3& centre, double radius, int subdivisions,
                            Facing facing = Facing::OUTWARD, Shading shading = Shading::FLAT);
    /// Any further OBJ text.
    SceneBuilder& raw(const std::string& text);

    /// The OBJ's text; it names `library` as its MTL. Positions are multiplied by `scale`.
    std::string obj(const std::string& library, double scale = 1) const;
    const std::string& mtl() const { return mtl_; }

private:
    struct Statement {
        std::string text; ///< of anything but a position
        bool is_position = false;
        glm::dvec3 position{0};
    };

    void vertex(const glm::dvec3& position);
    void line(const std::string& text);
    void face(size_t first_vertex, size_t count, bool textured);

    std::vector<Statement> statements_;
    std::string mtl_;
    size_t vertices_ = 0, normals_ = 0, uvs_ = 0;
};

/// A triangle's corners.
struct TestTriangle {
    glm::dvec3 corners[3];
};

/// The triangles of SceneBuilder::icosphere, outward.
std::vector<TestTriangle> icosphere_triangles(const glm::dvec3& centre, double radius, int subdivisions);

} // namespace clrt
