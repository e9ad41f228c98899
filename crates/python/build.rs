//! Sets how the module is linked, whoever builds it.

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    match std::env::var("CARGO_CFG_TARGET_OS").as_deref() {
        // Strips the names of functions, which nobody needs.
        Ok("linux") => println!("cargo::rustc-link-arg-cdylib=-s"),
        // The interpreter that loads it brings the functions of Python.
        Ok("macos") => {
            println!("cargo::rustc-link-arg-cdylib=-undefined");
            println!("cargo::rustc-link-arg-cdylib=dynamic_lookup");
        }
        _ => {}
    }
}
