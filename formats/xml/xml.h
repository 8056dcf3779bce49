// XML as a tree whose parts know their places: the skin over pugixml. Comments, declarations and processing
// instructions are passed over.
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"

namespace suite {

// A handle to one element (cheap to copy; keeps the document alive).
class XmlElement {
 public:
  // The root of a text in UTF-8. Error, located: no XML, not UTF-8, nested deeper than 200.
  static XmlElement parse(std::string_view text, const std::string& file_name);

  std::string_view name() const;
  // The texts between the child elements, joined, without blanks at the ends.
  std::string text() const;
  // Value of an attribute; none where it is not there.
  std::optional<std::string> attribute(const char* name) const;
  void each_attribute(const std::function<void(std::string_view name, std::string_view value)>& visit) const;
  // In the order written; of one name where that is given.
  void each_child(const std::function<void(const XmlElement&)>& visit) const;
  void each_child(const char* name, const std::function<void(const XmlElement&)>& visit) const;
  Where where() const;
  Error fault(std::string what, std::string hint = {}) const {
    return Error(where(), std::move(what), std::move(hint));
  }

 private:
  struct Document;
  XmlElement(std::shared_ptr<const Document> document, void* node) : document_(std::move(document)), node_(node) {}
  std::shared_ptr<const Document> document_;
  void* node_;  // of pugixml, in the document
};

}  // namespace suite
