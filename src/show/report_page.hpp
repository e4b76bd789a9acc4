// A page that viewer/ is bundled to, with its data put in.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace plica {

/// Bytes that a page finds by the id of their element, deflated, as base64.
struct PageBytes {
  std::string id, bytes;
};

/// The bundled pages without data: of runs, and of a study. Empty when plica was built without its viewer.
std::string_view report_template();
std::string_view study_template();

/// The page with its title and data. FileError when plica was built without its viewer.
std::string filled_page(std::string_view page, const std::string& title, const nlohmann::ordered_json& data,
                        const std::vector<PageBytes>& packed);

}  // namespace plica
