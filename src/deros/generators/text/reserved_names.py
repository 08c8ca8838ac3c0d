"""Names that a generated package must not have, since they hide modules or functions it needs."""

from __future__ import annotations

import sys
from collections.abc import Collection, Iterator, Sequence
from typing import TYPE_CHECKING

from deros import codes
from deros.diagnostics import Diagnostic, Span, report

if TYPE_CHECKING:
    from deros.interfaces.store import InterfaceStore
    from deros.models.node import NodeType

_PYTHON_PACKAGES_TEXT = """
    ament_copyright ament_flake8 ament_index_python ament_package ament_pep257 catkin_pkg
    colcon_core em flake8 lark launch launch_ros numpy osrf_pycommon packaging pep257
    pkg_resources pydocstyle pytest rclpy rosidl_adapter rosidl_generator_py rosidl_parser
    rosidl_pycommon rosidl_runtime_py rpyutils setuptools yaml
    """
_PYTHON_PACKAGES = frozenset(_PYTHON_PACKAGES_TEXT.split())
"""Modules that generated nodes, their launch files, builds and tests import."""

_CPP_PACKAGES_TEXT = """
    ament_cmake ament_index_cpp class_loader libstatistics_collector rcl rcl_action
    rcl_lifecycle rcl_logging_interface rcl_yaml_param_parser rclcpp rclcpp_action
    rclcpp_components rclcpp_lifecycle rcpputils rcutils rmw rmw_dds_common rmw_fastrtps_cpp
    rmw_implementation rosidl_dynamic_typesupport rosidl_runtime_c rosidl_runtime_cpp
    rosidl_typesupport_cpp rosidl_typesupport_interface rosidl_typesupport_introspection_cpp
    runtime spdlog std tracetools
    """
_CPP_PACKAGES = frozenset(_CPP_PACKAGES_TEXT.split())
"""Packages and namespaces that generated nodes are built from."""

_C_NAMES_TEXT = """
    a64l abort abs accept access acct acos acosf acosh acoshf acoshl acosl alarm aligned_alloc
    alloca arc4random arc4random_buf arc4random_uniform asctime asctime_r asin asinf asinh asinhf
    asinhl asinl asprintf atan atan2 atan2f atan2l atanf atanh atanhf atanhl atanl atexit atof
    atoi atol atoll basename bcmp bcopy bind bind_textdomain_codeset bindtextdomain brk bsearch
    btowc bzero calloc cbrt cbrtf cbrtl ceil ceilf ceill chdir chmod chown chroot clearenv
    clearerr clock clock_adjtime clock_getcpuclockid clock_getres clock_gettime clock_nanosleep
    clock_settime clone close close_range closefrom confstr connect copy_file_range copysign
    copysignf copysignl cos cosf cosh coshf coshl cosl creat crypt ctermid ctime ctime_r cuserid
    daddl daemon daylight dcgettext dcngettext ddivl dfmal dgettext difftime div dlclose dlerror
    dlopen dlsym dmull dngettext dprintf drand48 drand48_r drem dremf dreml dsqrtl dsubl dup dup2
    dup3 duplocale dysize eaccess ecvt ecvt_r endusershell environ epoll_wait erand48 erand48_r
    erf erfc erfcf erfcl erff erfl euidaccess execl execle execlp execv execve execveat execvp
    execvpe exit exp exp10 exp10f exp10l exp2 exp2f exp2l expf expl explicit_bzero expm1 expm1f
    expm1l fabs fabsf fabsl faccessat fadd faddl fchdir fchown fchownat fclose fcloseall fcntl
    fcvt fcvt_r fdatasync fdim fdimf fdiml fdiv fdivl fdopen feof ferror fexecve fflush ffma ffmal
    ffs ffsl ffsll fgetc fgetpos fgets fgetwc fgetws fileno finite finitef finitel flockfile floor
    floorf floorl fma fmaf fmal fmax fmaxf fmaxl fmemopen fmin fminf fminl fmod fmodf fmodl fmul
    fmull fopen fopencookie fork fpathconf fprintf fputc fputs fputwc fputws fread free freelocale
    freopen frexp frexpf frexpl fscanf fseek fseeko fsetpos fsqrt fsqrtl fstat fsub fsubl fsync
    ftell ftello ftime ftruncate ftrylockfile funlockfile fwide fwprintf fwrite fwscanf gamma
    gammaf gammal gcvt get_current_dir_name getc getchar getcpu getcwd getdate getdate_r getdelim
    getdomainname getdtablesize getegid getentropy getenv geteuid getgid getgroups gethostid
    gethostname getline getloadavg getlogin getlogin_r getopt getpagesize getpass getpgid getpgrp
    getpid getppid getpt getresgid getresuid getsid getsubopt gettext gettid getuid getusershell
    getw getwc getwchar getwd gmtime gmtime_r grantpt group_member gsignal hypot hypotf hypotl
    ilogb ilogbf ilogbl index initstate initstate_r ioctl isalnum isalpha isascii isatty isblank
    iscntrl isctype isdigit isgraph isinf isinff isinfl islower isnan isnanf isnanl isprint
    ispunct isspace isupper iswalnum iswalpha iswblank iswcntrl iswctype iswdigit iswgraph
    iswlower iswprint iswpunct iswspace iswupper iswxdigit isxdigit j0 j0f j0l j1 j1f j1l jn jnf
    jnl jrand48 jrand48_r kill killpg l64a labs lchown lcong48 lcong48_r ldexp ldexpf ldexpl ldiv
    lgamma lgamma_r lgammaf lgammaf_r lgammal lgammal_r link linkat listen llabs lldiv llogb
    llogbf llogbl llrint llrintf llrintl llround llroundf llroundl localeconv localtime
    localtime_r lockf log log10 log10f log10l log1p log1pf log1pl log2 log2f log2l logb logbf
    logbl logf logl longjmp lrand48 lrand48_r lrint lrintf lrintl lround lroundf lroundl lseek
    lstat malloc mblen mbrlen mbrtowc mbsinit mbsnrtowcs mbsrtowcs mbstowcs mbtowc memccpy memchr
    memcmp memcpy memfrob memmem memmove mempcpy memrchr memset mkdir mkdtemp mkfifo mknod
    mkostemp mkostemps mkstemp mkstemps mktemp mktime mmap modf modff modfl mrand48 mrand48_r nan
    nanf nanl nanosleep nearbyint nearbyintf nearbyintl newlocale nextafter nextafterf nextafterl
    nextdown nextdownf nextdownl nexttoward nexttowardf nexttowardl nextup nextupf nextupl
    ngettext nice nrand48 nrand48_r obstack_printf obstack_vprintf on_exit open open_memstream
    open_wmemstream openat optarg opterr optind optopt pathconf pause pclose perror pipe pipe2
    poll popen posix_memalign posix_openpt pow powf powl pread printf profil
    program_invocation_name pselect psiginfo psignal ptsname ptsname_r putc putchar putenv puts
    putw putwc putwchar pwrite qecvt qecvt_r qfcvt qfcvt_r qgcvt qsort qsort_r quick_exit raise
    rand rand_r random random_r rawmemchr read readlink readlinkat realloc reallocarray realpath
    recv remainder remainderf remainderl remove remquo remquof remquol rename renameat renameat2
    revoke rewind rindex rint rintf rintl rmdir round roundeven roundevenf roundevenl roundf
    roundl rpmatch sbrk scalb scalbf scalbl scalbln scalblnf scalblnl scalbn scalbnf scalbnl scanf
    sched_get_priority_max sched_get_priority_min sched_getaffinity sched_getcpu sched_getparam
    sched_getscheduler sched_rr_get_interval sched_setaffinity sched_setparam sched_setscheduler
    sched_yield secure_getenv seed48 seed48_r select send setbuf setbuffer setdomainname setegid
    setenv seteuid setgid sethostid sethostname setjmp setlinebuf setlocale setlogin setns setpgid
    setpgrp setregid setresgid setresuid setreuid setsid setstate setstate_r setuid setusershell
    setvbuf shutdown sigaction sigaddset sigaltstack sigandset sigblock sigdelset sigemptyset
    sigfillset siggetmask sighold sigignore siginterrupt sigisemptyset sigismember signal
    significand significandf significandl sigorset sigpause sigpending sigprocmask sigqueue
    sigrelse sigreturn sigset sigsetmask sigstack sigsuspend sigtimedwait sigwait sigwaitinfo sin
    sincos sincosf sincosl sinf sinh sinhf sinhl sinl sleep snprintf socket sprintf sqrt sqrtf
    sqrtl srand srand48 srand48_r srandom srandom_r sscanf ssignal stat stdio stpcpy stpncpy
    strcasecmp strcat strchr strcmp strcoll strcpy strcspn strdup strerror strerror_r strfromd
    strfromf strfroml strfry strftime strlen strncasecmp strncat strncmp strncpy strndup strnlen
    strpbrk strptime strrchr strsep strsignal strspn strstr strtod strtof strtok strtok_r strtol
    strtold strtoll strtoq strtoul strtoull strtouq strverscmp strxfrm swab swprintf swscanf
    symlink symlinkat sync syncfs syscall sysconf system sysv_signal tan tanf tanh tanhf tanhl
    tanl tcgetpgrp tcsetpgrp tempnam textdomain tgamma tgammaf tgammal tgkill time timegm
    timelocal timer_create timer_delete timer_getoverrun timer_gettime timer_settime times
    timespec timespec_get timespec_getres timeval timezone tm tmpfile tmpnam tmpnam_r toascii
    tolower toupper towctrans towlower towupper trunc truncate truncf truncl ttyname ttyname_r
    ttyslot tzset ualarm umask uname ungetc ungetwc unlink unlinkat unlockpt unsetenv unshare
    uselocale usleep valloc vasprintf vdprintf vfork vfprintf vfscanf vfwprintf vfwscanf vhangup
    vprintf vscanf vsnprintf vsprintf vsscanf vswprintf vswscanf vwprintf vwscanf wait waitpid
    wcpcpy wcpncpy wcrtomb wcscasecmp wcscat wcschrnul wcscmp wcscoll wcscpy wcscspn wcsdup
    wcsftime wcslen wcsncasecmp wcsncat wcsncmp wcsncpy wcsnlen wcsnrtombs wcsrtombs wcsspn wcstod
    wcstof wcstok wcstol wcstold wcstoll wcstombs wcstoq wcstoul wcstoull wcstouq wcswidth wcsxfrm
    wctob wctomb wctrans wctype wcwidth wmemcmp wmemcpy wmemmove wmempcpy wmemset wprintf write
    wscanf y0 y0f y0l y1 y1f y1l yn ynf ynl
    """
_C_NAMES = frozenset(_C_NAMES_TEXT.split())
"""What the headers of the C library, which rclcpp includes, declare outside any namespace."""


def hidden_from_python(
    models: Sequence[NodeType],
    needed: Collection[str],
    modules: Sequence[tuple[str, Span]],
    store: InterfaceStore | None,
) -> Iterator[Diagnostic]:
    """Yield a finding for each name that hides a module from the programs of a package in Python.

    A package is importable by its name wherever it is installed; a module of a package, when one of
    the package's modules is run as a program.

    Args:
        models: the nodes of the package.
        needed: the packages that it depends on.
        modules: further modules of the package, with their locations.
        store: the known interfaces, or ``None``.
    """
    package = models[0].package
    if (what := _python_module(package, needed, store)) is not None:
        yield _hidden(f"package {package!r}", what, models[0].package_span)
    named = [(model.name, model.name_span, "node") for model in models]
    for name, span, word in (*named, *((name, span, "module") for name, span in modules)):
        if (what := _python_module(name, needed, store)) is not None:
            yield _hidden(f"{word} {name!r}", what, span)


def hidden_by_script(name: str, span: Span, store: InterfaceStore | None) -> Iterator[Diagnostic]:
    """Yield a finding if a script hides a module: its folder is searched first when it is run.

    Args:
        name: of the script's file, without its extension.
        span: what the script is called after.
        store: the known interfaces, or ``None``.
    """
    if (what := _python_module(name, (), store)) is not None:
        yield _hidden(f"script '{name}.py'", what, span)


def _python_module(name: str, needed: Collection[str], store: InterfaceStore | None) -> str | None:
    if name in sys.stdlib_module_names:
        return f"the module {name!r} of Python's standard library"
    return _package(name, _PYTHON_PACKAGES.union(needed), store)


def hidden_from_cpp(
    models: Sequence[NodeType],
    needed: Collection[str],
    scopes: Sequence[tuple[str, Span]],
    store: InterfaceStore | None,
) -> Iterator[Diagnostic]:
    """Yield a finding for each namespace of a package in C++ that hides another name.

    Args:
        models: the nodes of the package, whose name is a namespace.
        needed: the packages that it depends on.
        scopes: further namespaces with their locations.
        store: the known interfaces, or ``None``.
    """
    package = models[0].package
    what = _package(package, _CPP_PACKAGES.union(needed), store)
    if what is None and package in _C_NAMES:
        what = f"{package!r} of the C library"
    if what is not None:
        yield _hidden(f"package {package!r}", what, models[0].package_span)
    for name, span in scopes:
        if name in _C_NAMES:
            yield _hidden(f"namespace {name!r}", f"{name!r} of the C library", span)
        elif (what := _package(name, _CPP_PACKAGES, None)) is not None:
            yield _hidden(f"namespace {name!r}", what, span)


def _package(name: str, needed: Collection[str], store: InterfaceStore | None) -> str | None:
    if name in needed or (store is not None and store.has_package(name)):
        return f"the package {name!r}, which nodes need"
    return None


def _hidden(what: str, hides: str, span: Span) -> Diagnostic:
    return report(codes.SHADOWED_MODULE, f"{what} hides {hides}", span, "choose another name")
