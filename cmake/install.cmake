# `cmake --install`: the program, its modules, what it says of itself for man and for shells, scenes, and documentation.
# Nothing of it names a folder outside of the prefix, which may be moved.
include(GNUInstallDirs)
# The modules are the program's own, and no library for others: lib/whit on every distribution, beside what it calls
# CMAKE_INSTALL_LIBDIR, so that the way there is the same from every prefix.
set_target_properties(whit PROPERTIES INSTALL_RPATH "$ORIGIN/../lib/whit")
install(TARGETS whit RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT whit)
install(TARGETS whit_oiio whit_http LIBRARY DESTINATION lib/whit COMPONENT whit)

install(DIRECTORY scenes DESTINATION ${CMAKE_INSTALL_DATADIR}/whit COMPONENT whit)
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/whit COMPONENT whit)
install(FILES README.md LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/whit COMPONENT whit)

# The program itself writes what is left, which one for another machine cannot here.
if(CMAKE_CROSSCOMPILING)
  return()
endif()
set(texts ${CMAKE_BINARY_DIR}/share)
file(MAKE_DIRECTORY ${texts})
add_custom_command(OUTPUT ${texts}/whit.1 ${texts}/whit ${texts}/_whit ${texts}/whit.fish
  COMMAND whit help --man > ${texts}/whit.1
  COMMAND whit help --completion bash > ${texts}/whit
  COMMAND whit help --completion zsh > ${texts}/_whit
  COMMAND whit help --completion fish > ${texts}/whit.fish
  DEPENDS whit VERBATIM)
add_custom_target(whit_texts ALL DEPENDS ${texts}/whit.1)
install(FILES ${texts}/whit.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT whit)
install(FILES ${texts}/whit DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions COMPONENT whit)
install(FILES ${texts}/_whit DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions COMPONENT whit)
install(FILES ${texts}/whit.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d COMPONENT whit)
