// SPDX-License-Identifier: Apache-2.0
// The log: plain lines on stderr, "clrt: warning: " and "clrt: error: " before what needs attention.
#include "app/log.h"

#include <memory>
#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

namespace clrt {

namespace {

/// The pattern's %*: the prefix of a level, empty for notices and details.
class LevelPrefix : public spdlog::custom_flag_formatter {
public:
    void format(const spdlog::details::log_msg& message, const std::tm&,
                spdlog::memory_buf_t& text) override {
        const spdlog::string_view_t prefix = message.level >= spdlog::level::err    ? "clrt: error: "
                                             : message.level == spdlog::level::warn ? "clrt: warning: "
                                                                                    : "";
        text.append(prefix.begin(), prefix.end());
    }
    std::unique_ptr<custom_flag_formatter> clone() const override { return std::make_unique<LevelPrefix>(); }
};

} // namespace

void start_log(int verbosity) {
    auto logger = std::make_shared<spdlog::logger>("clrt", std::make_shared<spdlog::sinks::stderr_sink_mt>());
    auto formatter = std::make_unique<spdlog::pattern_formatter>();
    formatter->add_flag<LevelPrefix>('*').set_pattern("%*%v");
    logger->set_formatter(std::move(formatter));
    logger->set_level(verbosity < 0   ? spdlog::level::err
                      : verbosity > 0 ? spdlog::level::debug
                                      : spdlog::level::info);
    spdlog::set_default_logger(std::move(logger));
}

} // namespace clrt
