//! Entries that are read, and mistakes that are told.

use super::*;

#[derive(Debug, Serialize, Deserialize)]
struct File {
    map: Option<MapEntry>,
    #[serde(default)]
    obstacle: Vec<ObstacleEntry>,
}

fn read(text: &str) -> Result<Obstacles, String> {
    let file: File = toml::from_str(text).map_err(|error| error.to_string())?;
    obstacles(&file.obstacle, file.map.as_ref(), Path::new("no/such"), 0.75).map_err(|error| error.to_string())
}

#[test]
fn discs_polygons_and_walls_are_read() {
    let text = "[[obstacle]]\nposition = [12, 5.0]\n[[obstacle]]\nname = \"shelf\"\n\
                polygon = [[2, 2], [6, 2], [6, 3], [3, 3], [3, 6], [2, 6]]\n\
                [[obstacle]]\nwall = [[0, 0], [10, 0], [10, 4]]\nthickness = 0.2\n";
    let all = read(text).unwrap();
    let names: Vec<&str> = all.list().iter().map(Obstacle::name).collect();
    assert_eq!((names, all.pieces().len()), (vec!["obstacle-0", "shelf", "obstacle-2"], 5));
    assert_eq!(all.list()[0].shape(), &Shape::Disc { centre: Position::new(12.0, 5.0), radius: 0.75 });
    let file: File = toml::from_str(text).unwrap();
    let copy: File = toml::from_str(&toml::to_string(&file).unwrap()).unwrap();
    assert_eq!(copy.obstacle, file.obstacle);
}

#[test]
fn mistakes_name_the_obstacle_and_what_is_allowed() {
    for (entry, parts) in [
        ("name = \"a\"", ["a: it has no shape", "polygon, wall and thickness, or region"]),
        ("position = [0, 0]\nwall = [[0, 0], [1, 0]]", ["obstacle-0", "both position and wall"]),
        ("polygon = [[0, 0], [1, 0], [1, 1]]\nradius = 1", ["radius does not belong to a polygon", "position"]),
        ("position = [0, 0]\nthickness = 1", ["thickness does not belong to a disc", "with wall"]),
        ("wall = [[0, 0], [1, 0]]", ["a wall needs a thickness", "0.2"]),
        ("polygon = [[0, 0], [1, 1], [1, 0], [0, 1]]", ["obstacle-0: the side from point 1", "point 3"]),
        ("polygon = [[0, 0], [1, 1, 2]]", ["line 2", "found 3 numbers"]),
        ("polygone = 1", ["unknown field `polygone`", "`polygon`"]),
    ] {
        let message = read(&format!("[[obstacle]]\n{entry}\n")).unwrap_err();
        for part in parts {
            assert!(message.contains(part), "`{part}` is not in: {message}");
        }
    }
}

#[test]
fn a_map_is_a_path_or_a_table() {
    let entry = |text: &str| toml::from_str::<File>(text).map(|file| file.map.unwrap());
    let short = entry("map = \"a.yaml\"").unwrap();
    assert_eq!(short, MapEntry { file: "a.yaml".into(), unknown: Unknown::Occupied, simplify: None });
    let long = entry("map = { file = \"a.yaml\", unknown = \"free\", simplify = 0.1 }").unwrap();
    assert_eq!(long, MapEntry { file: "a.yaml".into(), unknown: Unknown::Free, simplify: Some(0.1) });
    let copy = toml::to_string(&File { map: Some(long.clone()), obstacle: Vec::new() }).unwrap();
    assert_eq!(entry(&copy).unwrap(), long);
    for (text, part) in [
        ("map = 1", "the path of a map or a table"),
        ("map = { file = \"a\", unknown = \"maybe\" }", "`occupied` or `free`"),
        ("map = { file = \"a\", simplify = -1.0 }", "at least 0"),
        ("map = { unknown = \"free\" }", "missing field `file`"),
    ] {
        let message = entry(text).unwrap_err().to_string();
        assert!(message.contains(part), "`{part}` is not in: {message}");
    }
    assert!(read("map = \"a.yaml\"").unwrap_err().contains("no/such/a.yaml"));
}
