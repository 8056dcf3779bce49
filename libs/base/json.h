// A JSON value to build and write; keys keep the order in which they were set, numbers keep all their digits,
// NaN and infinity become null. Reading JSON goes through Params, which knows lines and columns.
#pragma once
#include <concepts>
#include <memory>
#include <string>
#include <string_view>

namespace suite {

class Json {
 public:
  static Json object();
  static Json array();
  Json(const char* text) : Json(std::string_view(text)) {}
  Json(std::string_view text);
  Json(const std::string& text) : Json(std::string_view(text)) {}
  Json(bool value);
  Json(double value);
  template <std::integral T>
  requires(!std::same_as<T, bool>) Json(T value) : Json(Integer{static_cast<long long>(value)}) {}
  Json(Json&&) noexcept;
  Json& operator=(Json&&) noexcept;
  ~Json();

  void set(const std::string& key, Json value);  // of an object
  void push(Json value);                         // of an array
  std::string text(int indent = 2) const;        // with a final newline

 private:
  struct Integer {
    long long value;
  };
  explicit Json(Integer value);
  struct Value;
  std::unique_ptr<Value> value_;
};

}  // namespace suite
