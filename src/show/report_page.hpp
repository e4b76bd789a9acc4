// Pages bundled from viewer/, and insertion of data.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace plica {

/// Bytes for an element of the page with this id; inserted deflated, as base64.
struct PageBytes {
  std::string id, bytes;
};

/// Bundled pages without data, for runs and studies; empty in builds without the viewer.
std::string_view report_template();
std::string_view study_template();

/// Insert title and data into a page. Throws FileError in builds without the viewer.
std::string filled_page(std::string_view page, const std::string& title, const nlohmann::ordered_json& data,
                        const std::vector<PageBytes>& packed);

}  // namespace plica
