// SPDX-License-Identifier: Apache-2.0
#include "naive/naive_kernels.h"

#include "error.h"

#include <filesystem>
#include <fstream>

namespace clrt {

/// The files below tools/naive/kernels, inside the program.
const KernelFiles& naive_kernel_files();

namespace {

/// Where a kernel file has a text.
size_t find_text(const KernelFiles& files, const std::string& file, const std::string& text) {
    const auto found = files.find(file);
    const size_t at = found == files.end() ? std::string::npos : found->second.find(text);
    if (at == std::string::npos)
        throw SceneError(
            file, 0,
            "expected '" + text +
                "' in this kernel file, found none; give a folder of kernels of this version to --kernels");
    return at;
}

/// Gives a macro another value.
void redefine(KernelFiles& files, const std::string& file, const std::string& macro,
              const std::string& value) {
    const std::string start = "#define " + macro + " ";
    const size_t at = find_text(files, file, start);
    std::string& text = files.at(file);
    text.replace(at, text.find('\n', at) - at, start + value);
}

/// Replaces a function from its return type, which follows `static inline`, to its closing brace.
void replace_function(KernelFiles& files, const std::string& file, const std::string& head,
                      const std::string& by) {
    const std::string start = "static inline " + head, end = "\n}\n";
    const size_t at = find_text(files, file, start);
    std::string& text = files.at(file);
    text.replace(at, text.find(end, at) + end.size() - at, by);
}

} // namespace

KernelFiles with_naive(KernelFiles files, bool triangle, bool box) {
    if (triangle)
        files["geometry/triangle.h"] = naive_kernel_files().at("triangle.h");
    if (box) {
        redefine(files, "geometry/box.h", "BOX_PAD_ROUNDINGS", "REAL(0.0)");
        redefine(files, "geometry/box.h", "BOX_EXIT_FACTOR", "REAL(1.0)");
    }
    return files;
}

KernelFiles with_naive_offset(KernelFiles files) {
    replace_function(files, "geometry/surface.h", "real3 surface_origin(",
                     naive_kernel_files().at("ray_offset.h"));
    return files;
}

void replace_in_kernel(KernelFiles& files, const std::string& file, const std::string& from,
                       const std::string& to) {
    files.at(file).replace(find_text(files, file, from), from.size(), to);
}

void write_kernel_files(const KernelFiles& files, const std::string& folder) {
    for (const auto& [name, text] : files) {
        const std::filesystem::path path = std::filesystem::path(folder) / name;
        std::filesystem::create_directories(path.parent_path());
        std::ofstream(path, std::ios::binary) << text;
    }
}

} // namespace clrt
