function %(complete_func)s
    set -l token (commandline -ct)
    set -l before (string match --regex '^.*=' -- $token)
    set -l behind (string replace --regex '^.*=' '' -- $token)
    for answer in (env %(complete_var)s=fish_complete COMP_WORDS=(commandline -cp) COMP_CWORD="$token" %(prog_name)s)
        set -l parts (string split --max 1 , -- $answer)
        switch $parts[1]
            case dir
                printf "$before%%s\n" (__fish_complete_directories "$behind")
            case file
                printf "$before%%s\n" (__fish_complete_path "$behind")
            case plain
                echo -- "$before$parts[2]"
        end
    end
end

complete --no-files --command %(prog_name)s --arguments '(%(complete_func)s)'
