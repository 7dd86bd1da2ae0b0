# brume_embed_text(OUT VARIABLE FILES …)
#
# Keeps text (a page's template, its style, a shader) in files of its own, and compiles it in: one
# header, <VARIABLE>.h in the current binary folder, with a namespace brume::VARIABLE that holds one
# `constexpr const char` array a file, named after it (report.css: report_css). A file may hold up
# to 64 KiB and not the characters ")brume". OUT receives the header's path, to be listed among a
# target's sources; the header is written anew when a file changes.
if (CMAKE_SCRIPT_MODE_FILE)
  set(code "// Written by BrumeEmbedText.cmake.\n#pragma once\n\nnamespace brume::${VARIABLE}\n{\n")
  string(REPLACE "|" ";" files "${FILES}")
  foreach (file IN LISTS files)
    file(READ "${file}" text)
    string(FIND "${text}" ")brume" clash)
    string(LENGTH "${text}" length)
    if (NOT clash EQUAL -1 OR length GREATER 65536)
      message(FATAL_ERROR "${file}: too long, or it holds the mark )brume: split or reword it")
    endif ()
    get_filename_component(name "${file}" NAME)
    string(MAKE_C_IDENTIFIER "${name}" name)
    string(APPEND code "\ninline constexpr const char ${name}[] = R\"brume(${text})brume\";\n")
  endforeach ()
  file(WRITE "${OUTPUT}" "${code}\n}\n")
  return()
endif ()

set(BRUME_EMBED_TEXT_SCRIPT "${CMAKE_CURRENT_LIST_FILE}")

function (brume_embed_text out variable)
  cmake_parse_arguments(PARSE_ARGV 2 arg "" "" "FILES")
  list(TRANSFORM arg_FILES PREPEND "${CMAKE_CURRENT_SOURCE_DIR}/")
  set(header "${CMAKE_CURRENT_BINARY_DIR}/${variable}.h")
  list(JOIN arg_FILES "|" joined)
  add_custom_command(OUTPUT "${header}"
    COMMAND "${CMAKE_COMMAND}" "-DVARIABLE=${variable}" "-DFILES=${joined}" "-DOUTPUT=${header}"
      -P "${BRUME_EMBED_TEXT_SCRIPT}"
    DEPENDS ${arg_FILES} "${BRUME_EMBED_TEXT_SCRIPT}"
    COMMENT "Embedding ${variable}"
    VERBATIM)
  set(${out} "${header}" PARENT_SCOPE)
endfunction ()
