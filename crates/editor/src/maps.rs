//! Names of the built-in maps in menus, and their tooltips.

use hairline_sky::BuiltInMap;

/// Name in a menu.
pub fn name(map: BuiltInMap) -> &'static str {
    match map {
        BuiltInMap::Studio => "Studio map",
        BuiltInMap::Window => "Room with a window",
        BuiltInMap::Overcast => "Overcast sky",
    }
}

/// Description of its effect on the look, for a tooltip.
pub fn tooltip(map: BuiltInMap) -> &'static str {
    match map {
        BuiltInMap::Studio => {
            "Three soft boxes around and a strip above in a dark room: clear reflections on metal, with dark between them."
        }
        BuiltInMap::Window => {
            "A tall window with bars, cool, in a dim and warm room: shapes an object from one side."
        }
        BuiltInMap::Overcast => {
            "An even grey sky, brightest above, over dark ground: soft light without highlights; scratches keep little colour."
        }
    }
}
