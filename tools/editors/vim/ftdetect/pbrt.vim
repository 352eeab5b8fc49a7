au BufNewFile,BufRead *.pbrt setfiletype pbrt
