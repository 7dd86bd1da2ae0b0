// Pages are files with gaps; this fills the gaps.
#pragma once

#include <nlohmann/json.hpp>

#include <string>
#include <string_view>

namespace brume
{

/// Fills a template, written in a small part of the Mustache language:
///
///     {{name}}                 the value as text, escaped for HTML text and attributes
///     {{{name}}}               the value as it stands
///     {{.}}                    the current element of a list
///     {{#name}} … {{/name}}    the part once for each element of a list; once for a value that is
///                              neither null, false, an empty text, list nor object
///     {{^name}} … {{/name}}    the part where {{#name}} gives nothing
///
/// A name is looked up in the current element, then in what surrounds it. Throws std::logic_error
/// for a name that nothing holds, a value that is no text or number, and a part that is not closed:
/// a mistake in a template is found by its first use.
std::string fill_template(std::string_view text, const nlohmann::ordered_json& values);

/// The text with & < > " ' as character references, and what is not UTF-8 replaced.
std::string escape_html(std::string_view text);

}
