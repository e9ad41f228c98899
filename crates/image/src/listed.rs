//! Enumerations whose values have names: menus, lists and options are made of them.

/// Declares an enumeration with `ALL`, its values in this order, and a method that returns the text beside each; a second method
/// where there are two texts.
///
/// ```
/// hairline_image::listed! {
///     /// A side.
///     #[derive(Clone, Copy)]
///     pub enum Side {
///         /// Towards the sun.
///         Front = "front";
///         /// Away from it.
///         Back = "back";
///     }
///     /// Name in a menu.
///     fn name;
/// }
/// assert_eq!(Side::ALL.map(Side::name), ["front", "back"]);
/// ```
#[macro_export]
macro_rules! listed {
    (
        $(#[$meta:meta])*
        $vis:vis enum $Type:ident {
            $($(#[$of:meta])* $Variant:ident = $text:literal;)*
        }
        $(#[$doc:meta])*
        fn $method:ident;
    ) => {
        $(#[$meta])*
        $vis enum $Type {
            $($(#[$of])* $Variant),*
        }

        impl $Type {
            /// All values, in the order of lists.
            $vis const ALL: [Self; [$($text),*].len()] = [$(Self::$Variant),*];

            $(#[$doc])*
            $vis fn $method(self) -> &'static str {
                match self {
                    $(Self::$Variant => $text),*
                }
            }
        }
    };
    (
        $(#[$meta:meta])*
        $vis:vis enum $Type:ident {
            $($(#[$of:meta])* $Variant:ident = $text:literal, $second:literal;)*
        }
        $(#[$doc:meta])*
        fn $method:ident;
        $(#[$second_doc:meta])*
        fn $second_method:ident;
    ) => {
        $crate::listed! {
            $(#[$meta])*
            $vis enum $Type {
                $($(#[$of])* $Variant = $text;)*
            }
            $(#[$doc])*
            fn $method;
        }

        impl $Type {
            $(#[$second_doc])*
            $vis fn $second_method(self) -> &'static str {
                match self {
                    $(Self::$Variant => $second),*
                }
            }
        }
    };
}
