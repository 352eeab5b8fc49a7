" Vim settings for pbrt-v3 scene files.

if exists("b:did_ftplugin")
  finish
endif
let b:did_ftplugin = 1

setlocal comments=:# commentstring=#\ %s
setlocal suffixesadd=.pbrt
" gf and [i follow Include.
setlocal include=^\\s*Include
setlocal foldmethod=syntax foldlevel=99
if executable("whit")
  " gq writes lines in normal form; gggqG the file.
  setlocal formatprg=whit\ fmt\ -
  compiler whit
endif
" % jumps between the ends of a block.
let b:match_words = '\<\(World\|Attribute\|Transform\|Object\)Begin\>:\<\1End\>'

let b:undo_ftplugin = "setlocal comments< commentstring< suffixesadd< include< foldmethod< foldlevel< formatprg< makeprg< errorformat<"
      \ . " | unlet! b:match_words"
