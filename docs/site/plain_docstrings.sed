# Docstrings are plain text, in which Doxygen would take a backslash for a command and angle brackets for HTML.
\#^ *///#{
s#\\#\\\\#g
s#&#\&amp;#g
s#<#\&lt;#g
s#>#\&gt;#g
s#^\( *\)///&lt;#\1///<#
}
s#///< \(.*\)<\(.*\)>#///< \1\&lt;\2\&gt;#
