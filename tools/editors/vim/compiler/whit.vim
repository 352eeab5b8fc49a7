" :make checks the scene with whit.

if exists("current_compiler")
  finish
endif
let current_compiler = "whit"

CompilerSet makeprg=whit\ check\ %:S
" file:line:column: error: message, then the line, a caret and what to do, which are left out.
CompilerSet errorformat=%f:%l:%c:\ %trror:\ %m,%f:%l:%c:\ %tarning:\ %m,%-G%.%#
