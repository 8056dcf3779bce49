#include "base/json.h"

#include <nlohmann/json.hpp>

namespace suite {

struct Json::Value {
  nlohmann::ordered_json json;
};

Json Json::object() {
  Json j("");
  j.value_->json = nlohmann::ordered_json::object();
  return j;
}
Json Json::array() {
  Json j("");
  j.value_->json = nlohmann::ordered_json::array();
  return j;
}
Json::Json(std::string_view text) : value_(new Value{nlohmann::ordered_json(text)}) {}
Json::Json(bool value) : value_(new Value{nlohmann::ordered_json(value)}) {}
Json::Json(double value) : value_(new Value{nlohmann::ordered_json(value)}) {}
Json::Json(Integer value) : value_(new Value{nlohmann::ordered_json(value.value)}) {}
Json::Json(Json&&) noexcept = default;
Json& Json::operator=(Json&&) noexcept = default;
Json::~Json() = default;

void Json::set(const std::string& key, Json value) { value_->json[key] = std::move(value.value_->json); }
void Json::push(Json value) { value_->json.push_back(std::move(value.value_->json)); }
std::string Json::text(int indent) const {
  // Invalid UTF-8 from somebody's file name must not make the report fail.
  return value_->json.dump(indent, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace suite
