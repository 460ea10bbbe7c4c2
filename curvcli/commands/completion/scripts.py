"""Completion scripts, one per shell: each runs the program to get the words that can stand at the cursor.

The program prints words, or `file` or `dir` where the shell completes these itself. Behind the last `=` of a word, as
in `--area=mixed` or `edges=out.csv`, the words are values; the script keeps the text before.
"""

from __future__ import annotations

from click.shell_completion import BashComplete, FishComplete, ShellComplete, ZshComplete, add_completion_class

# Bash splits words at `=` by itself; a name that needs a value gets no blank behind its `=`. Before version 4.4 it
# has neither `nosort` nor `compopt`, and completes files where there are no words.
_BASH = """\
%(complete_func)s() {
    local kind value
    COMPREPLY=()
    while IFS=, read -r kind value; do
        case $kind in
            dir) compopt -o dirnames 2>/dev/null ;;
            file) compopt -o default 2>/dev/null ;;
            plain)
                COMPREPLY+=("$value")
                [[ $value == *= ]] && compopt -o nospace 2>/dev/null
                ;;
        esac
    done < <(env COMP_WORDS="${COMP_WORDS[*]}" COMP_CWORD="$COMP_CWORD" %(complete_var)s=bash_complete "$1")
    return 0
}

complete -o nosort -F %(complete_func)s %(prog_name)s 2>/dev/null ||
    complete -o default -F %(complete_func)s %(prog_name)s
"""

_ZSH = """\
#compdef %(prog_name)s

%(complete_func)s() {
    local -a response plain waiting described
    local kind value help
    (( $+commands[%(prog_name)s] )) || return 1
    response=("${(@f)$(env COMP_WORDS="${words[*]}" COMP_CWORD=$((CURRENT - 1)) %(complete_var)s=zsh_complete \
%(prog_name)s)}")
    compset -P '*='
    for kind value help in "${response[@]}"; do
        case $kind in
            dir) _path_files -/ ;;
            file) _path_files ;;
            plain)
                if [[ $value == *= ]]; then
                    waiting+=("$value")
                elif [[ $help == _ ]]; then
                    plain+=("$value")
                else
                    described+=("$value:$help")
                fi
                ;;
        esac
    done
    (( $#described )) && _describe -V unsorted described
    (( $#plain )) && compadd -V unsorted -a plain
    (( $#waiting )) && compadd -V unsorted -S '' -a waiting
    return 0
}

if [[ $zsh_eval_context[-1] == loadautofunc ]]; then
    %(complete_func)s "$@"
else
    compdef %(complete_func)s %(prog_name)s
fi
"""

_FISH = """\
function %(complete_func)s
    set -l token (commandline -ct)
    set -l before (string match --regex '^.*=' -- $token)
    set -l behind (string replace --regex '^.*=' '' -- $token)
    for answer in (env %(complete_var)s=fish_complete COMP_WORDS=(commandline -cp) COMP_CWORD="$token" %(prog_name)s)
        set -l parts (string split --max 1 , -- $answer)
        switch $parts[1]
            case dir
                printf "$before%%s\\n" (__fish_complete_directories "$behind")
            case file
                printf "$before%%s\\n" (__fish_complete_path "$behind")
            case plain
                echo -- "$before$parts[2]"
        end
    end
end

complete --no-files --command %(prog_name)s --arguments '(%(complete_func)s)'
"""


class Bash(BashComplete):
    """Bash, which splits `--area=mixed` into three words."""

    source_template = _BASH

    def get_completion_args(self) -> tuple[list[str], str]:
        """The words before the cursor, and the one at it."""
        arguments, incomplete = super().get_completion_args()
        if len(arguments) > 1 and arguments[-1] == "=" and arguments[-2].startswith("-"):
            arguments.pop()
        return arguments, incomplete


class Zsh(ZshComplete):
    """zsh."""

    source_template = _ZSH


class Fish(FishComplete):
    """fish."""

    source_template = _FISH


ASKING: dict[str, type[ShellComplete]] = {"bash": Bash, "zsh": Zsh, "fish": Fish}

for _name, _shell in ASKING.items():
    add_completion_class(_shell, _name)
