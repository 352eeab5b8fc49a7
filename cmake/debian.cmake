# Run by cpack between installing and packing: what Debian asks of a package beyond its files.
if(CPACK_WHIT_ARCH STREQUAL "native")
  message(FATAL_ERROR "this build is for this machine's processor alone, and a package is for others: "
                      "configure with `cmake --preset portable` and call cpack in build/portable")
endif()
file(GLOB_RECURSE manual ${CPACK_TEMPORARY_DIRECTORY}/whit.1)
if(NOT manual)
  message(FATAL_ERROR "there is no whit.1 in ${CPACK_TEMPORARY_DIRECTORY}")
endif()
get_filename_component(share ${manual}/../../.. ABSOLUTE)
set(doc ${share}/doc/whit)

# Without the time in the file, which would differ from one package to the next.
function(compress file)
  execute_process(COMMAND gzip -9 -n --force ${file} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

# Where Debian's zsh looks for what packages bring.
file(MAKE_DIRECTORY ${share}/zsh/vendor-completions)
file(RENAME ${share}/zsh/site-functions/_whit ${share}/zsh/vendor-completions/_whit)
file(REMOVE_RECURSE ${share}/zsh/site-functions)

# Debian keeps the text of this licence itself.
file(REMOVE ${doc}/LICENSE)
file(WRITE ${doc}/copyright "\
Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/
Upstream-Name: whit

Files: *
Copyright: 2026 The whit authors
License: Apache-2.0
 On Debian systems the full text of the Apache License, version 2.0, is in
 /usr/share/common-licenses/Apache-2.0.
")
file(WRITE ${doc}/changelog "\
whit (${CPACK_PACKAGE_VERSION}) bookworm; urgency=medium

  * See the history of the repository.

 -- ${CPACK_PACKAGE_CONTACT}  Thu, 01 Jan 2026 00:00:00 +0000
")
compress(${doc}/changelog)
compress(${manual})
