// SPDX-License-Identifier: Apache-2.0
#include "scene/load_scene.h"

#include "error.h"
#include "output/standard_streams.h"
#include "scene/assemble_geometry.h"
#include "scene/camera_fit.h"
#include "scene/cut_vast.h"
#include "scene/emission.h"
#include "scene/environment.h"
#include "scene/far_notices.h"
#include "scene/ground.h"
#include "scene/lights.h"
#include "scene/material_override.h"
#include "scene/material_rules.h"
#include "scene/normalise.h"
#include "scene/readers/mtl_libraries.h"
#include "scene/readers/mtl_repair.h"
#include "scene/readers/obj_reader.h"
#include "scene/scene_up.h"
#include "scene/smoothing.h"
#include "scene/studio.h"
#include "scene/text_scanner.h"
#include "scene/texture_store.h"
#include "scene/vertex_colours.h"
#include "scene/view_frame.h"

#include <chrono>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <new>
#include <optional>

namespace clrt {
namespace {

/// Seconds since it was made.
class Stopwatch {
public:
    double seconds() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    }

private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// The materials of the libraries and what turns them into the scene's.
struct MaterialReader {
    std::map<std::string, MtlMaterial> library;
    MaterialContext context;
    LoadMap load_map;
    std::optional<MapFacts> facts;                    ///< for the repairs; absent: --mtl plain
    const MaterialReplacement* replacement = nullptr; ///< of all materials; null: each is itself
};

/// The material behind a usemtl name; a name that no library defines is grey, with a notice. `first_colour`
/// is given where the material's triangles have coloured vertices.
RuledMaterial material_by_name(const std::string& name, size_t line, const std::string& obj_path,
                               const MaterialReader& reader, const std::optional<SourcePlace>& first_colour,
                               SourcePlace& place, NoticeList& notices) {
    const auto coloured = [&](const MtlMaterial& material) {
        return first_colour ? with_vertex_colours(material, *first_colour, notices) : material;
    };
    const auto rule = [&](const MtlMaterial& material) {
        if (!reader.replacement)
            return rule_material(coloured(material), reader.context, reader.load_map, notices);
        const MtlMaterial replaced = replace_material(material, *reader.replacement, notices);
        RuledMaterial ruled = rule_material(replaced, reader.context, reader.load_map, notices);
        ruled.rule = reader.replacement->rule;
        return ruled;
    };
    const auto found = reader.library.find(name);
    if (found != reader.library.end()) {
        const MtlMaterial& mtl = found->second;
        place = mtl.place;
        return rule(reader.facts ? repair_material(mtl, *reader.facts, notices) : mtl);
    }
    place = {obj_path, line};
    if (!name.empty())
        notices.add(fmt::format("usemtl {}: no library defines it, matte {} is taken", clrt::quoted(name),
                                first_colour ? "with the colours of the vertices" : "grey (Kd 0.8)"),
                    place);
    if (reader.replacement)
        return rule({});
    if (first_colour)
        return {rule({}).material, "no material: matte, Kd of the vertices"};
    return default_material();
}

/// Reads the libraries and gives every material that a face uses its meaning. Returns what each emits:
/// luminance, mean over its map, times coverage, doubled where both sides shine.
std::vector<double> load_materials(ObjMesh& mesh, const Options& options, Progress& progress, Scene& scene,
                                   NoticeList& notices) {
    MaterialReader reader;
    reader.replacement = find_replacement(options.scene.material_override);
    if (reader.replacement)
        mesh.colours.clear();
    std::vector<bool> coloured = coloured_materials(mesh);
    decode_vertex_colours(mesh, input_name(options.scene.path), notices);
    if (mesh.colours.empty())
        coloured.assign(mesh.material_names.size(), false);
    TextureStore store;
    const auto timed = [&](const auto& question) {
        const Stopwatch watch;
        const auto answer = question();
        scene.statistics.texture_seconds += watch.seconds();
        return answer;
    };
    reader.library = read_mtl_libraries(input_name(options.scene.path), mesh.libraries, notices, scene.files);
    reader.context = {scene.normalisation.scale, options.light.two_sided};
    reader.load_map = [&](const MtlTexture& use, TextureRole role) {
        return timed([&] { return store.add(use, role, notices); });
    };
    if (options.scene.mtl == MtlReading::AUTO) {
        note_writers(reader.library, notices);
        reader.facts = MapFacts{
            [&](const MtlTexture& use, TextureRole role) {
                return timed([&] { return store.is_readable(use, role, notices); });
            },
            [&](const MtlTexture& use) { return timed([&] { return store.is_normal_map(use, notices); }); }};
    }
    std::vector<double> exitance;
    for (size_t i = 0; i < mesh.material_names.size(); ++i) {
        progress.update({"textures", double(i) / double(mesh.material_names.size())});
        SourcePlace place;
        std::optional<SourcePlace> first_colour;
        if (coloured[i])
            first_colour = {input_name(options.scene.path), mesh.first_colour_line};
        const RuledMaterial ruled =
            material_by_name(mesh.material_names[i], mesh.material_lines[i], input_name(options.scene.path),
                             reader, first_colour, place, notices);
        const Material& m = ruled.material;
        scene.emitted.push_back(emitted_radiance(m, store));
        exitance.push_back(emitted_luminance(m, scene.emitted.back()));
        scene.materials.push_back(m);
        scene.material_names.push_back(mesh.material_names[i]);
        scene.material_places.push_back(place);
        scene.material_rules.push_back(ruled.rule);
    }
    for (const std::string& path : store.files())
        scene.files.push_back({"the texture", path});
    scene.textures = store.take_textures();
    scene.texture_names = store.take_names();
    scene.texture_places = store.take_places();
    scene.texel_words = store.take_words();
    return exitance;
}

/// Emitters first, which the studio asks for; the ground last, which no fit may see.
void load_camera_and_lights(const Options& options, const std::vector<double>& exitance, const Bounds& bounds,
                            Scene& scene, NoticeList& notices) {
    Emitters emitters = build_emitters(scene.positions, scene.triangles, exitance);
    scene.emitters = std::move(emitters.emitters);
    LightOptions light = options.light;
    const bool has_light = !scene.emitters.empty() || !light.points.empty() || !light.suns.empty();
    scene.is_studio = light.studio && !has_light && !light.environment && light.environment_file.empty();
    scene.camera = fit_camera(options.camera, options.film.size, scene, bounds, notices);
    note_far_options(scene.camera, bounds, options, notices);
    const glm::dvec3 up = options.camera.up.value_or(DEFAULT_UP);
    if (scene.is_studio)
        light = studio_light(light, scene, up, notices);

    Lights lights =
        build_lights(light, scene.normalisation, bounds.radius() * scene.normalisation.scale, notices);
    scene.lights = std::move(lights.lights);
    scene.emitted_power = emitters.power + lights.power;
    scene.environment =
        load_environment(light, has_light, sky_sampling(options.transport.integrator), notices);
    if (light.background)
        scene.background = light.background->radiance;
    if (light.ground && light.ground->albedo)
        append_ground(glm::normalize(up), *light.ground->albedo, scene);
}

/// The options with the scene's own up where none is given.
Options with_up(const Options& given, const ObjMesh& mesh, const Bounds& bounds, NoticeList& notices) {
    Options options = given;
    if (options.camera.up)
        return options;
    const FoundUp found = find_up(mesh, bounds);
    const bool is_fitted = !options.camera.eye;
    if (found.is_sure && is_fitted)
        options.camera.up = UP_Z;
    if (found.is_z_likely)
        notices.add_line(fmt::format(options.camera.up
                                         ? "{}: z is taken as up, --up z, since {}; --up y keeps y"
                                         : "{}: it looks as if z is up, since {}: --up z turns it",
                                     input_name(options.scene.path), found.reason));
    return options;
}

Scene load_all(const Options& given, Progress& progress) {
    Scene scene;
    NoticeList notices;

    // Geometry and names.
    const Stopwatch watch;
    ObjMesh mesh = read_obj(given.scene.path, progress);
    scene.statistics.obj_seconds = watch.seconds();
    scene.statistics.obj_bytes = mesh.bytes;
    scene.statistics.dropped_faces = mesh.dropped_faces;
    for (const std::string& line : mesh.notices)
        notices.add_line(line);
    scene.object_names = mesh.object_names;

    // The frame, then everything that is measured in it.
    const Bounds bounds = bounds_of_triangles(mesh);
    const Options options = with_up(given, mesh, bounds, notices);
    scene.normalisation = fit_normalisation(bounds);
    note_coarse_digits(mesh, bounds, input_name(options.scene.path), notices);
    note_relative_positions(scene.normalisation, options, notices);
    smooth_by_groups(mesh, input_name(options.scene.path), notices);
    const std::vector<double> exitance = load_materials(mesh, options, progress, scene, notices);
    assemble_geometry(mesh, bounds, scene.normalisation, input_name(options.scene.path), scene, notices);
    const CutTriangles cut = cut_vast_triangles(scene);
    if (cut.vast)
        notices.add_line(fmt::format("{}: {} triangles are vast beside what lies near them: cut into {}",
                                     input_name(options.scene.path), cut.vast, cut.vast + cut.added));
    store_vertex_colours(scene, input_name(options.scene.path));
    load_camera_and_lights(options, exitance, bounds, scene, notices);
    scene.notices = notices.lines();
    return scene;
}

} // namespace

Scene load_scene(const Options& options, Progress& progress) {
    try {
        return load_all(options, progress);
    } catch (const std::bad_alloc&) {
        throw SceneError(
            input_name(options.scene.path), 0,
            "not enough memory to load the scene: expected a smaller one, smaller textures, or a "
            "machine with more memory");
    }
}

} // namespace clrt
