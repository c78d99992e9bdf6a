// SPDX-License-Identifier: Apache-2.0
// Writes one kernel with a scene's arguments around each statement list.
#include "probes/scene_probe.h"

#include "probes/ray_device.h"
#include "render/scene_buffers.h"

#include <fmt/format.h>
#include <utility>

namespace clrt {

SceneProbe::SceneProbe(const ProbeDevice& device, std::vector<std::string> headers, const std::string& text,
                       const ProbeOptions& options)
    : device_(device), probe_(device, std::move(headers), options) {
    probe_.add_text("vec4 probe_vec4(real3 v, real w) { return (vec4)(convert_float3(v), (float)w); }\n" +
                    text);
}

void SceneProbe::add(const std::string& name, const std::string& statements) {
    probe_.add_text(fmt::format(
        "CLRT_KERNEL void probe_{}(SCENE_PARAMS, const RenderParams params_value, const u32 count, global "
        "const "
        "vec4* in_a,\n"
        "                     global const vec4* in_b, global const vec4* in_c, global vec4* out_first,\n"
        "                     global vec4* out_second, global vec4* out_third)\n"
        "{{\n"
        "    const u32 i = (u32)get_global_id(0);\n"
        "    if (i >= count)\n"
        "        return;\n"
        "    const Scene scene_value = SCENE_MAKE;\n"
        "    const Scene* const scene = &scene_value;\n"
        "    const RenderParams* const params = &params_value;\n"
        "    const vec4 a = in_a[i], b = in_b[i], c = in_c[i];\n"
        "    vec4 first = (vec4)(0.0f), second = first, third = first;\n"
        "    {{ {} }}\n"
        "    out_first[i] = first;\n"
        "    out_second[i] = second;\n"
        "    out_third[i] = third;\n"
        "}}\n",
        name, statements));
}

SceneProbe::Outputs SceneProbe::run(const std::string& name, const Scene& scene, const RenderParams& params,
                                    const std::vector<vec4>& a, std::vector<vec4> b, std::vector<vec4> c) {
    b.resize(a.size());
    c.resize(a.size());
    Kernel kernel = probe_.kernel("probe_" + name);
    bind_scene(upload_scene(device_, scene, Bvh{}), kernel);
    kernel.set("params_value", params);
    kernel.set("count", u32(a.size()));
    kernel.set("in_a", probe_.upload(a));
    kernel.set("in_b", probe_.upload(b));
    kernel.set("in_c", probe_.upload(c));
    const size_t bytes = a.size() * sizeof(vec4);
    const cl::Buffer first = create_buffer(device_, "first", bytes);
    const cl::Buffer second = create_buffer(device_, "second", bytes);
    const cl::Buffer third = create_buffer(device_, "third", bytes);
    kernel.set("out_first", first);
    kernel.set("out_second", second);
    kernel.set("out_third", third);
    probe_.launch(kernel, a.size());
    return {probe_.read<vec4>(first, a.size()), probe_.read<vec4>(second, a.size()),
            probe_.read<vec4>(third, a.size())};
}

} // namespace clrt
