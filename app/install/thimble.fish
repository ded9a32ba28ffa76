# Completion of thimble in fish: the words of the bash completion, which is installed beside it.
function __thimble_words
    set -l here (dirname (status filename))
    for file in $here/../../bash-completion/completions/thimble $here/thimble.bash
        test -r $file; or continue
        set -l words (commandline -opc) (commandline -ct)
        bash -c 'source "$1"; shift; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _thimble; printf "%s\n" "${COMPREPLY[@]}"' \
            _ $file $words 2>/dev/null
        return
    end
end
complete -c thimble -f -a '(__thimble_words)'
