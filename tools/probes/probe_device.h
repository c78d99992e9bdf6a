// SPDX-License-Identifier: Apache-2.0
// A device, the kernels that probes and small renders take there, and what they have made on it so far.
#pragma once

#include "device/device.h"
#include "device/kernel_source.h"

#include <map>
#include <memory>
#include <string>

namespace clrt {

class ProbeDevice : public Device {
public:
    /// `kernels_folder` as in --kernels; empty: the kernels inside the program.
    ProbeDevice(Device device, std::string kernels_folder);
    ProbeDevice(const ProbeDevice&) = delete;
    ProbeDevice& operator=(const ProbeDevice&) = delete;

    const std::string& kernels_folder() const { return kernels_folder_; }

    /// The kernel files; read anew at every call. Throws SceneError for a folder that cannot be read.
    KernelFiles kernels() const;

    /// What `make()` gave when it was first asked for under this key. Programs take seconds to compile: so
    /// one serves all that asks for it, and ends with the device. A key belongs to one type `T`.
    template <class T, class Make>
    T& once(const std::string& key, const Make& make) const {
        std::shared_ptr<void>& made = made_[key];
        if (!made)
            made = std::make_shared<T>(make());
        return *static_cast<T*>(made.get());
    }

private:
    std::string kernels_folder_;
    mutable std::map<std::string, std::shared_ptr<void>> made_;
};

} // namespace clrt
