//! What documents tell to type runs, and what they tell to write into files is read. `hairline_fixtures::documents` finds it, and says where
//! other languages are tested.
//!
//! A `hairline` command is parsed as it stands, and run on a small scene under the name that it has there. One that cannot be run (a window,
//! hours) has a comment with the reason above its block. Of other programs it is tested that what they name exists: targets, features and flags
//! by cargo itself, then files and versions.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Mutex;

use hairline_fixtures::documents::{Block, documents, root};

use crate::common::{SCRATCHED, command, stderr_of};

/// Programs of which nothing is tested but the files that they get.
const OTHERS: [&str; 6] = ["npm", "pip", "python3", "python3.11", "cd", "tar"];
/// In which a part of a scene stands. Its objects are disks of the last material.
const AROUND: &str = "[camera]\nposition_m = [0, -0.2, 0.3]\ntarget_m = [0, 0, 0]\n\n[[material]]\nname = \"base\"\nkind = \"metal\"\nmetal = \"steel\"\nroughness = 0.1\n";
/// What cargo was asked already.
static CHECKED: Mutex<BTreeSet<String>> = Mutex::new(BTreeSet::new());
/// Without one there is a studio, whose maps take three seconds.
const LAMP: &str =
    "\n[[light]]\nkind = \"sphere\"\ncenter_m = [0, 0.1, 0.3]\nradius_m = 0.01\nradiance = 9\n";
const LIST: &str = "[[scratches]]\nobject = \"list\"\npattern = \"file\"\nfile = \"list.csv\"\n";

#[test]
fn code_in_documents_runs() {
    for (document, blocks) in documents() {
        let folder = Folder::new(&document);
        for block in &blocks {
            let (place, text) = (&block.place, &*block.text);
            match &*block.language {
                "sh" => folder.shell(block),
                "toml" if text.contains("[camera]") => folder.scene(block),
                "toml" => folder.part(block, text),
                "csv" => {
                    folder.write("list.csv", text);
                    folder.part(block, LIST);
                }
                "json" => {
                    let json = serde_json::from_str::<serde_json::Value>(&format!("{{{text}}}"));
                    assert!(json.is_ok(), "{place}: {json:?}");
                }
                "rust" => {
                    let example = root().join("packages/hairline-bevy/examples/documents.rs");
                    let example = code_of(&fs::read_to_string(example).unwrap());
                    let is_there = example.contains(&code_of(text));
                    assert!(
                        is_there,
                        "{place}: must be in documents.rs of hairline-bevy"
                    );
                }
                // By the tests of these languages.
                "python" | "js" | "html" => {}
                // No code.
                "math" | "text" => {}
                other => panic!("{place}: found {other:?}; must be a language with a test"),
            }
            let may_have_reasons = ["sh", "python"].contains(&&*block.language);
            let is_right = block.not_run.is_none() || may_have_reasons;
            assert!(is_right, "{place}: a comment without need");
        }
    }
}

/// Without what formatting changes: comments, spaces, and commas before brackets.
fn code_of(text: &str) -> String {
    let lines = text.lines().filter_map(|line| line.split("//").next());
    let code: String = lines.flat_map(str::split_whitespace).collect();
    code.replace(",)", ")")
        .replace(",}", "}")
        .replace(",]", "]")
}

/// Whether a file is handed out: its name has the version.
fn is_package(file: &str) -> bool {
    let endings = [".tgz", ".whl", ".tar.gz"];
    endings.iter().any(|ending| file.ends_with(ending))
}

/// Where the commands of a document are typed.
struct Folder {
    made: tempfile::TempDir,
    /// The folder of the repository that it stands for.
    stands_for: PathBuf,
}

impl Folder {
    fn new(document: &str) -> Self {
        let package = document.strip_suffix("/README.md").unwrap_or_default();
        let package = Some(package).filter(|it| it.starts_with("packages"));
        let folder = Self {
            stands_for: root().join(package.unwrap_or_default()),
            made: tempfile::tempdir().unwrap(),
        };
        for scenes in ["scenes", "tests/shadows"] {
            for scene in fs::read_dir(root().join(scenes)).unwrap() {
                let name = scene.unwrap().file_name().into_string().unwrap();
                if name.ends_with(".toml") {
                    folder.write(&format!("{scenes}/{name}"), &SCRATCHED);
                }
            }
        }
        folder
    }

    fn write(&self, file: &str, text: &str) {
        let path = self.made.path().join(file);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }

    /// Writes a scene, with fewer scratches, into the file that the text before it names.
    fn scene(&self, block: &Block) {
        let mut names = block.before.split('`').filter(|it| it.ends_with(".toml"));
        let name = names
            .next_back()
            .unwrap_or_else(|| panic!("{}: has no name", block.place));
        let few = |line: &str| match line.split_once(" = ") {
            Some((key @ ("count" | "density_per_m2"), _)) => format!("{key} = 20\n"),
            _ => format!("{line}\n"),
        };
        self.write_with_files(name, &block.text.lines().map(few).collect::<String>());
        self.hairline(block, &["info", name]);
    }

    fn part(&self, block: &Block, part: &str) {
        let value = |line: &str| Some(line.split_once(" = \"")?.1.strip_suffix('"')?.to_owned());
        let names = |key: &str| {
            let of_key = part.lines().filter(|line| line.starts_with(key));
            of_key.filter_map(value).collect::<Vec<_>>()
        };
        let material = if part.contains("[[material]]") {
            &names("name")[0]
        } else {
            "base"
        };
        let mut scene = AROUND.to_owned();
        for object in names("object ").iter().take(1) {
            scene += &format!(
                "[[object]]\nname = \"{object}\"\nshape = {{ disk = {{ radius_m = 0.09 }} }}\nmaterial = \"{material}\"\n"
            );
        }
        if !part.contains("object") {
            scene += &format!(
                "[[object]]\nname = \"it\"\nshape = {{ disk = {{ radius_m = 0.09 }} }}\nmaterial = \"{material}\"\n"
            );
        }
        self.write_with_files("part.toml", &(scene + part));
        self.run(block, &["render", "part.toml", "-o", "part.png"]);
    }

    /// Pictures that it names are the reader's, and models the repository's.
    fn write_with_files(&self, name: &str, scene: &str) {
        let lamp = if scene.contains("[[light]]") {
            ""
        } else {
            LAMP
        };
        self.write(name, &format!("{scene}{lamp}"));
        for name in scene.split('"').skip(1).step_by(2) {
            let file = match name.rsplit_once('.') {
                Some((_, "png")) => "scenes/maps/petals.png",
                Some((_, "glb")) => name,
                _ => continue,
            };
            self.write(name, "");
            fs::copy(root().join(file), self.made.path().join(name)).expect(name);
        }
    }

    fn shell(&self, block: &Block) {
        let mut all_run = true;
        for line in block.text.lines() {
            let line = line.split("# ").next().unwrap_or(line);
            for typed in line.split(" && ") {
                // What is between quotes is one word, of which nothing is looked at.
                let bare: String = typed.split('"').step_by(2).collect();
                let words: Vec<&str> = bare.split_whitespace().collect();
                // Settings of the environment, and a program that starts another one.
                let is_before =
                    |word: &&&str| word.contains('=') || **word == "xvfb-run" || **word == "-s";
                let words = &words[words.iter().take_while(is_before).count()..];
                match words {
                    [] => {}
                    ["hairline" | "./hairline", arguments @ ..] => {
                        all_run &= self.run(block, arguments)
                    }
                    // What follows is typed in a project of the reader's.
                    ["cargo", "init", ..] => break,
                    ["cargo", arguments @ ..] => all_run &= self.cargo(block, arguments),
                    [program, ..] => {
                        let is_known = OTHERS.contains(program) || program.contains('/');
                        assert!(is_known, "{}: {program} is not known", block.place);
                        let is_file = |word: &&&str| word.contains('/') || is_package(word);
                        let files = words.iter().filter(is_file);
                        files.for_each(|file| self.must_exist(block, file));
                    }
                }
            }
        }
        let is_told = all_run == block.not_run.is_none();
        assert!(
            is_told,
            "{}: what is not run, and nothing else, must have `<!-- not run: REASON -->` above it",
            block.place
        );
    }

    /// Whether it could be run, or need not be.
    fn cargo(&self, block: &Block, arguments: &[&str]) -> bool {
        let end = arguments.iter().position(|word| *word == "--");
        let (own, rest) = arguments.split_at(end.unwrap_or(arguments.len()));
        let value = |flag| Some(own[own.iter().position(|word| *word == flag)? + 1]);
        let mut check = Command::new(env!("CARGO"));
        check.current_dir(root());
        match own {
            // By its own parser: `xtask/src/main.rs`.
            ["xtask", ..] => return true,
            ["long"] => {
                let settings = fs::read_to_string(root().join(".cargo/config.toml")).unwrap();
                assert!(settings.contains("\nlong = "), "{}", block.place);
                return true;
            }
            ["lab", task, flags @ ..] => {
                let file = root().join(format!("lab/src/{task}.rs"));
                let text = fs::read_to_string(&file).expect(task);
                let flags = flags.iter().filter_map(|word| word.strip_prefix("--"));
                let mut missing = flags.filter(|flag| !text.contains(&format!("\n    {flag}: ")));
                assert_eq!(missing.next(), None, "{}: no flag of {task}", block.place);
                return true;
            }
            // Outside of the workspace, of whose dependencies none need be there.
            _ if self.stands_for.join("Cargo.lock").exists()
                && !self.stands_for.join("xtask").exists() =>
            {
                let example = value("--example").map(|name| format!("examples/{name}.rs"));
                example.iter().for_each(|file| self.must_exist(block, file));
                return true;
            }
            ["run", flags @ ..] => check.arg("build").args(flags),
            ["build" | "test" | "bench", ..] => check.args(own),
            // An alias may hold `--`, so that what is added below would build.
            _ => panic!("{}: cargo {} is not known", block.place, own[0]),
        };
        // Resolves what is named, and builds nothing.
        check
            .args(["--offline", "-Zunstable-options", "--unit-graph"])
            .env("RUSTC_BOOTSTRAP", "1");
        // A third of a second each.
        if CHECKED.lock().unwrap().insert(own.join(" ")) {
            let checked = check.output().unwrap();
            let said = String::from_utf8_lossy(&checked.stderr);
            assert!(checked.status.success(), "{}: {own:?}: {said}", block.place);
        }
        let rest = rest.get(1..).unwrap_or_default();
        match (own[0], value("-p"), value("--example")) {
            ("run", Some("hairline-viewer"), _) => self.run(block, &[&["view"], rest].concat()),
            ("run", None | Some("hairline"), None) => self.run(block, rest),
            _ => true,
        }
    }

    /// Whether it can be run.
    fn run(&self, block: &Block, arguments: &[&str]) -> bool {
        // Flags and values as they stand.
        self.hairline(block, &[arguments, &["--help"]].concat());
        let mut small = arguments.to_vec();
        // Models, and the built-in scene, lay sixty thousand scratches.
        let scene = small.get(1).filter(|word| !word.starts_with('-')).copied();
        scene.iter().for_each(|file| self.must_exist(block, file));
        if scene.is_some_and(|file| file.ends_with(".glb")) {
            small[1] = "scenes/plate.toml";
        } else if scene.is_none() && small[0] == "render" {
            small.insert(1, "scenes/plate.toml");
        }
        let mut set = |flag, value| match small.iter().position(|word| *word == flag) {
            Some(i) => small[i + 1] = value,
            None if small[0] == "render" && !["--frames", "--spp"].contains(&flag) => {
                small.extend([flag, value]);
            }
            None => {}
        };
        set("--size", "24x16");
        set("--samples", "1");
        set("--spp", "1");
        set("--frames", "2");
        set("--backend", "cpu");
        if arguments[0] == "reference" {
            set("--time", "1ms");
        }
        if let Some(i) = small.iter().position(|word| *word == "-o") {
            let folder = Path::new(small[i + 1]).parent().unwrap();
            fs::create_dir_all(self.made.path().join(folder)).unwrap();
        }
        let can_run = !["view", "bench"].contains(&arguments[0]) && !arguments.contains(&"--watch");
        if can_run {
            self.hairline(block, &small);
        }
        can_run
    }

    fn hairline(&self, block: &Block, arguments: &[&str]) {
        let line = arguments.join(" ");
        let run = command(self.made.path(), &line).assert();
        let is_right = run.get_output().status.success();
        assert!(
            is_right,
            "{}: hairline {line}: {}",
            block.place,
            stderr_of(&run)
        );
    }

    /// A file that is there or was made, unless it stands for one of the reader's, or is built.
    fn must_exist(&self, block: &Block, file: &str) {
        let is_there = if is_package(file) {
            file.contains(concat!("-", env!("CARGO_PKG_VERSION")))
        } else {
            let is_built =
                file.contains("/path/") || file.contains("target/") || file.contains(".venv");
            is_built
                || [self.made.path(), &self.stands_for]
                    .iter()
                    .any(|it| it.join(file).exists())
        };
        assert!(is_there, "{}: {file} is no file", block.place);
    }
}
