// SPDX-License-Identifier: Apache-2.0
// The log: plain lines on stderr, "PROGRAM: warning: " and "PROGRAM: error: " before what needs attention.
#include "app/log.h"

#include <memory>
#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>
#include <string>
#include <utility>

namespace clrt {

namespace {

/// The pattern's %*: the prefix of a level, empty for notices and details.
class LevelPrefix : public spdlog::custom_flag_formatter {
public:
    explicit LevelPrefix(std::string program) : program_(std::move(program)) {}
    void format(const spdlog::details::log_msg& message, const std::tm&,
                spdlog::memory_buf_t& text) override {
        if (message.level < spdlog::level::warn)
            return;
        const std::string prefix =
            program_ + (message.level == spdlog::level::warn ? ": warning: " : ": error: ");
        text.append(prefix.data(), prefix.data() + prefix.size());
    }
    std::unique_ptr<custom_flag_formatter> clone() const override {
        return std::make_unique<LevelPrefix>(program_);
    }

private:
    std::string program_;
};

} // namespace

void start_log(int verbosity, const std::string& program) {
    auto logger = std::make_shared<spdlog::logger>("clrt", std::make_shared<spdlog::sinks::stderr_sink_mt>());
    auto formatter = std::make_unique<spdlog::pattern_formatter>();
    formatter->add_flag<LevelPrefix>('*', program).set_pattern("%*%v");
    logger->set_formatter(std::move(formatter));
    logger->set_level(verbosity < 0   ? spdlog::level::err
                      : verbosity > 0 ? spdlog::level::debug
                                      : spdlog::level::info);
    spdlog::set_default_logger(std::move(logger));
}

} // namespace clrt
