#include "page/live_page.h"

#include <algorithm>

#include "base/error.h"
#include "base/markup.h"
#include "page/live_texts.h"
#include "page/steps.h"

namespace suite {

namespace {

std::string_view live_text(const std::string& name) {
  for (const LiveText& t : live_texts())
    if (t.name == name) return t.text;
  throw Error("libs/page/live has no '" + name + "'");
}

const char* name_of(LiveKind kind) {
  switch (kind) {
    case LiveKind::half:
      return "half";
    case LiveKind::log8:
      return "log8";
    case LiveKind::u8:
      return "u8";
    case LiveKind::u32:
      return "u32";
    default:
      return "f32";
  }
}

std::string attributes_of(LiveKind kind, double first, double second) {
  return strf(" data-kind=\"%s\" data-first=\"%.9g\" data-second=\"%.9g\"", name_of(kind), first, second);
}

// JSON inside an element: nothing in it may look like the element's end. "<" stands in strings alone.
std::string in_element(const Json& value) {
  const std::string text = value.text(0);
  std::string safe;
  for (const char c : text) c == '<' ? safe += "\\u003c" : safe += c;
  return safe;
}

}  // namespace

size_t live_page_size(const std::vector<std::string>& scripts, const Json& about) {
  constexpr size_t kRest = 2048;  // elements, policy and title
  size_t size = kRest + live_text("live.css").size() + live_text("live.js").size() + live_text("steps.js").size() +
                in_element(about).size();
  for (const std::string& name : scripts) size += live_text(name).size();
  return size;
}

std::string base64(std::span<const std::byte> bytes) {
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text((bytes.size() + 2) / 3 * 4, '=');
  size_t to = 0;
  for (size_t i = 0; i < bytes.size(); i += 3) {
    const size_t n = std::min<size_t>(3, bytes.size() - i);
    unsigned three = 0;
    for (size_t k = 0; k < 3; ++k) three = three << 8 | (k < n ? std::to_integer<unsigned>(bytes[i + k]) : 0);
    for (size_t k = 0; k < n + 1; ++k) text[to + k] = kDigits[three >> (18 - 6 * k) & 63];
    to += 4;
  }
  return text;
}

LivePage::LivePage(const std::string& path, const std::string& title, const std::vector<std::string>& scripts,
                   const Json& about)
    : file_(path) {
  file_.write(
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; script-src 'unsafe-inline'; "
      "style-src 'unsafe-inline'; img-src data: blob:\"><link rel=\"icon\" href=\"data:,\"><title>" +
      in_markup(title) + "</title>\n<style>\n" + std::string(live_text("live.css")) + "</style></head>\n<body><h1>" +
      in_markup(title) + "</h1><main id=\"app\"></main><noscript>This page draws with JavaScript.</noscript>\n");
  json("about", about);
  std::vector<std::string> all{"live.js", "steps.js"};
  all.insert(all.end(), scripts.begin(), scripts.end());
  for (const std::string& name : all) file_.write("<script>\n" + std::string(live_text(name)) + "</script>\n");
}

void LivePage::data(const std::string& id, LiveKind kind, std::span<const std::byte> bytes, double first,
                    double second) {
  block(id, attributes_of(kind, first, second), bytes);
}

void LivePage::steps(const std::string& id, LiveKind kind, const Packed& packed, const std::optional<Base>& base) {
  std::string attributes = attributes_of(kind, packed.first, packed.second);
  attributes += strf(" data-count=\"%zu\"", packed.codes.size());
  if (base) attributes += " data-base=\"" + base->id + "\"";
  block(id, attributes, in_steps(packed.codes, base ? base->codes : std::span<const uint16_t>{}));
}

void LivePage::block(const std::string& id, const std::string& attributes, std::span<const std::byte> bytes) {
  file_.write("<script type=\"text/plain\" id=\"" + id + "\"" + attributes + ">");
  file_.write(base64(bytes));
  file_.write("</script>\n");
}

void LivePage::json(const std::string& id, const Json& value) {
  file_.write("<script type=\"application/json\" id=\"" + id + "\">" + in_element(value) + "</script>\n");
}

void LivePage::begin() { file_.write("<script>begin();</script>\n"); }

void LivePage::commit() {
  file_.write("<script>ready();</script>\n</body></html>\n");
  file_.commit();
}

}  // namespace suite
